#include <firstcontact/edges/detail/straight_ways.h>

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/edges/detail/pose_numbers.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRandomDirections = 24;

}  // namespace

std::vector<Eigen::VectorXd> directions_at(const ConfigurationSpace& space, const Configuration& q,
                                           RandomNumbers& random) {
  const std::size_t coordinates = space.coordinates().size();
  const auto size = static_cast<Eigen::Index>(coordinates + 3 * space.poses().size());
  std::vector<Eigen::VectorXd> all;
  const auto add = [&](const Eigen::VectorXd& v) {
    all.push_back(v);
    all.emplace_back(-v);
  };
  for (Eigen::Index k = 0; k < size; ++k) {
    add(Eigen::VectorXd::Unit(size, k));
  }
  for (std::size_t pose = 0; pose < space.poses().size(); ++pose) {
    const Eigen::Matrix3d R =
        pose_at(q, space.begin_of_pose(pose)).rotation.normalized().toRotationMatrix();
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd v = Eigen::VectorXd::Zero(size);
      v.segment<3>(static_cast<Eigen::Index>(coordinates + 3 * pose)) = R.col(k);
      add(v);
    }
  }
  while (all.size() < kRandomDirections + static_cast<std::size_t>(4 * size)) {
    Eigen::VectorXd v(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      v[k] = 2.0 * random.uniform() - 1.0;
    }
    if (v.norm() > 0.1 && v.norm() <= std::sqrt(static_cast<double>(size))) {
      all.emplace_back(v.normalized());
    }
  }
  return all;
}

Configuration behind_way(const ConfigurationSpace& space, const Configuration& q,
                         const Eigen::VectorXd& direction, double way) {
  Configuration place = q;
  const std::size_t coordinates = space.coordinates().size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(direction.size()); ++k) {
    const std::size_t in_poses = k < coordinates ? 0 : k - coordinates;
    const std::size_t number =
        k < coordinates ? k : space.begin_of_pose(in_poses / 3) + in_poses % 3;
    place[number] += way * direction[static_cast<Eigen::Index>(k)];
  }
  return space.is_in_box(place) ? place : q;
}

}  // namespace firstcontact::detail
