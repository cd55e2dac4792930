#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/detail/pose_numbers.h>
#include <firstcontact/edges/detail/robot_sizes.h>

namespace firstcontact {
namespace {

/// [m]  The sum of the sizes of a position's numbers.
double place_size(const std::vector<double>& sizes, std::size_t first) {
  return sizes[first] + sizes[first + 1] + sizes[first + 2];
}

}  // namespace

double ConfigurationSpace::rounding_bound(const Configuration& from, const Configuration& to,
                                          double carried) const {
  if (has_screws()) {
    return std::numeric_limits<double>::infinity();
  }
  constexpr double kUlps = 0x1p-48;  // More than the rounding errors of a place and of its edge.
  std::vector<double> sizes(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) {
    sizes[k] = std::abs(from[k]) + std::abs(to[k]);
  }
  constexpr double kNearHalfTurn = 1e-9;  // [rad]  A rounded place may be beyond it.
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const std::size_t first = begin_of_pose(k);
    if (detail::angle_between(detail::pose_at(from, first).rotation,
                              detail::pose_at(to, first).rotation) >
        std::numbers::pi - kNearHalfTurn) {
      return std::numeric_limits<double>::infinity();
    }
  }
  double bound = 0.0;  // The sum over the movers, as two of them may be a pair.
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    const Mover& mover = movers_[k];
    double lever = mover.reach;
    if (mover.rest) {
      const detail::RobotSizes robot = detail::robot_sizes(*mover.rest, k, coordinates_, sizes);
      // A radian moves a point by at most the length of its robot, with sliding joints drawn out.
      // A slide moves all points alike.
      lever += carried + robot.slides;
      for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
        lever += poses_[pose].mover == k ? place_size(sizes, begin_of_pose(pose)) : 0.0;
      }
      bound += robot.planned_slides + robot.planned_turns * lever;
    }
    for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
      bound += poses_[pose].mover == k ? pose_rounding(pose, sizes, lever) : 0.0;
    }
  }
  return kUlps * bound;
}

/// [m]  The sizes of a pose's numbers, by the lengths that they move points.
///
/// What a pose moves turns about its own origin. Rounded quaternions move a point by at most its
/// distance from there times their error, wherever the origin is. Rounded positions move all points
/// alike.
///
/// @param lever  [m]  bounds that distance
double ConfigurationSpace::pose_rounding(std::size_t pose, const std::vector<double>& sizes,
                                         double lever) const {
  const std::size_t first = begin_of_pose(pose);
  const double turns = sizes[first + 3] + sizes[first + 4] + sizes[first + 5] + sizes[first + 6];
  return place_size(sizes, first) + turns * lever;
}

}  // namespace firstcontact
