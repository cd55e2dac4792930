#include <firstcontact/edges/detail/straight_ways.h>

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRandomDirections = 24;

}  // namespace

std::vector<Eigen::VectorXd> directions_at(const ConfigurationSpace& space, const Configuration& q,
                                           RandomNumbers& random) {
  const auto size = static_cast<Eigen::Index>(space.is_body() ? 3 : space.size());
  std::vector<Eigen::VectorXd> all;
  const auto add = [&](const Eigen::VectorXd& v) {
    all.push_back(v);
    all.emplace_back(-v);
  };
  for (Eigen::Index k = 0; k < size; ++k) {
    add(Eigen::VectorXd::Unit(size, k));
  }
  if (space.is_body()) {
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
    for (int k = 0; k < 3; ++k) {
      add(R.col(k));
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
  for (std::size_t k = 0; k < static_cast<std::size_t>(direction.size()); ++k) {
    place[k] += way * direction[static_cast<Eigen::Index>(k)];
  }
  return space.is_body() && !space.is_in_box(place) ? q : place;
}

}  // namespace firstcontact::detail
