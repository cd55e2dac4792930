#include <firstcontact/haptic_devices/operator_path.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <firstcontact/haptic_devices/detail/rotation_vector.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact {
namespace {

void require_finite(const ViaPoint& point) {
  const double length = point.X_DH.rotation.coeffs().norm();
  if (!std::isfinite(point.time) || !point.X_DH.position.allFinite() ||
      !(length > 1e-9 && length < 1e9)) {
    throw std::invalid_argument("ViaPoint: a number is not finite, or the quaternion is zero");
  }
}

void require(bool holds, const char* what) {
  if (!holds) {
    throw std::invalid_argument(std::string("RandomPathOptions::") + what);
  }
}

}  // namespace

OperatorPath::OperatorPath(std::vector<ViaPoint> points) {
  if (points.empty()) {
    throw std::invalid_argument("OperatorPath: at least one via point is needed");
  }
  for (ViaPoint& point : points) {
    require_finite(point);
    point.X_DH.rotation.normalize();
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ViaPoint& from = points[i - 1];
    const ViaPoint& to = points[i];
    if (!(from.time < to.time)) {
      throw std::invalid_argument("OperatorPath: the times of via points must increase, point " +
                                  std::to_string(i) + " does not");
    }
    pieces_.push_back({from.time, to.time - from.time, from.X_DH,
                       to.X_DH.position - from.X_DH.position,
                       detail::vector_of(to.X_DH.rotation * from.X_DH.rotation.conjugate())});
  }
  first_ = points.front().X_DH;
  last_ = points.back().X_DH;
  end_time_ = points.back().time;
}

double OperatorPath::end_time() const noexcept { return end_time_; }

HandTarget OperatorPath::at(double time, std::size_t& hint) const noexcept {
  if (pieces_.empty() || !(time > pieces_.front().begin)) {
    return {first_};
  }
  if (time >= end_time_) {
    return {last_};
  }
  std::size_t i = hint < pieces_.size() ? hint : 0;
  while (i > 0 && time < pieces_[i].begin) {
    --i;
  }
  while (i + 1 < pieces_.size() && time >= pieces_[i + 1].begin) {
    ++i;
  }
  hint = i;
  const Piece& piece = pieces_[i];
  const double u = (time - piece.begin) / piece.duration;
  const double share = u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
  const double rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / piece.duration;
  HandTarget target;
  target.X_DH.position = piece.from.position + share * piece.translation;
  target.X_DH.rotation = detail::rotation_of(share * piece.rotation_vector) * piece.from.rotation;
  target.velocity = rate * piece.translation;
  target.angular_velocity = rate * piece.rotation_vector;
  return target;
}

std::vector<ViaPoint> random_via_points(const RandomPathOptions& options) {
  require(options.count > 0, "count must be > 0");
  require(options.radius >= 0.0 && std::isfinite(options.radius), "radius must be >= 0");
  require(options.max_angle >= 0.0 && options.max_angle <= std::numbers::pi,
          "max_angle must be in [0, pi]");
  require(
      options.slowest > 0.0 && options.fastest >= options.slowest && std::isfinite(options.fastest),
      "slowest must be > 0, and fastest no less");
  require(options.most_turn_rate > 0.0, "most_turn_rate must be > 0");
  require(options.longest_rest >= 0.0 && std::isfinite(options.longest_rest),
          "longest_rest must be >= 0");
  RandomNumbers random(options.seed);
  std::vector<ViaPoint> points{{0.0, options.centre}};
  double time = 0.0;
  for (std::size_t i = 1; i < options.count; ++i) {
    const Pose& from = points.back().X_DH;
    Pose to;
    to.position = options.centre.position + options.radius * random.in_ball();
    const Eigen::Vector3d axis = random.direction();
    to.rotation = detail::rotation_of(random.uniform(0.0, options.max_angle) * axis) *
                  options.centre.rotation;
    const double distance = (to.position - from.position).norm();
    const double angle = detail::vector_of(to.rotation * from.rotation.conjugate()).norm();
    const double duration = std::max(distance / random.uniform(options.slowest, options.fastest),
                                     angle / options.most_turn_rate);
    const double rest = random.uniform(0.0, options.longest_rest);
    if (rest > 0.0) {
      points.push_back({time + rest, from});
    }
    time += rest + std::max(duration, 1e-3);
    points.push_back({time, to});
  }
  return points;
}

}  // namespace firstcontact
