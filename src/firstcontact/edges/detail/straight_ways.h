/// @file
/// Straight ways from a place, along axes and in random directions.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact::detail {

/// Number of times that a way is doubled: from micrometres to metres.
inline constexpr int kWayDoublings = 24;

/// Unit vectors of ways from a place.
///
/// They are along each joint, and along the axes of each pose's frame and of what it moves; then
/// some in random directions.
///
/// @returns a number for each coordinate, then 3 for each pose, which does not turn
[[nodiscard]] std::vector<Eigen::VectorXd> directions_at(const ConfigurationSpace& space,
                                                         const Configuration& q,
                                                         RandomNumbers& random);

/// The place at the end of a way; the place itself where a pose would leave its box.
///
/// @param way  [m, or rad and m alike]
[[nodiscard]] Configuration behind_way(const ConfigurationSpace& space, const Configuration& q,
                                       const Eigen::VectorXd& direction, double way);

}  // namespace firstcontact::detail
