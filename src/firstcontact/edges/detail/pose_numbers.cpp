#include <firstcontact/edges/detail/pose_numbers.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

Pose pose_at(const Configuration& q, std::size_t first) {
  return {{q[first], q[first + 1], q[first + 2]},
          Eigen::Quaterniond(q[first + 3], q[first + 4], q[first + 5], q[first + 6])};
}

void set_pose(const Pose& pose, std::size_t first, Configuration& q) {
  const Configuration numbers = configuration_of(pose);
  std::copy(numbers.begin(), numbers.end(), q.begin() + static_cast<std::ptrdiff_t>(first));
}

double angle_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond way = from.conjugate() * to;
  return 2.0 * std::atan2(way.vec().norm(), std::abs(way.w()));
}

bool is_same_pose(const Configuration& a, const Configuration& b, std::size_t first) {
  const auto begin = static_cast<std::ptrdiff_t>(first);
  return std::equal(a.begin() + begin, a.begin() + begin + kPoseNumbers, b.begin() + begin);
}

std::optional<std::string> defect_of_pose(const Configuration& q, std::size_t first) {
  constexpr double kUnit = 1e-6;  // [-]  As in scenes.
  const double size =
      Eigen::Vector4d(q[first + 3], q[first + 4], q[first + 5], q[first + 6]).norm();
  if (!(std::abs(size - 1.0) <= kUnit)) {
    return "expected a quaternion of length 1, got one of length " + write_json(size);
  }
  return std::nullopt;
}

bool is_in_box(const SpacePose& pose, const Configuration& q, std::size_t first) {
  for (std::size_t k = 0; k < pose.has_limits.size(); ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const bool is_within = q[first + k] >= pose.low[axis] && q[first + k] <= pose.high[axis];
    if (pose.has_limits.at(k) && !is_within) {
      return false;
    }
  }
  return true;
}

double body_distance(const Pose& from, const Pose& to, double reach) {
  return (to.position - from.position).norm() + reach * angle_between(from.rotation, to.rotation);
}

Pose sample_pose(const SpacePose& box, RandomNumbers& random) {
  Pose pose;
  for (Eigen::Index k = 0; k < 3; ++k) {
    pose.position[k] = random.uniform(box.low[k], box.high[k]);
  }
  // K. Shoemake, "Uniform random rotations", Graphics Gems III (1992).
  const double u = random.uniform();
  const double a = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double b = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - u);
  const double s = std::sqrt(u);
  pose.rotation =
      Eigen::Quaterniond(s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b))
          .normalized();
  return pose;
}

}  // namespace firstcontact::detail
