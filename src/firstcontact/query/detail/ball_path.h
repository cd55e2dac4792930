/// @file
/// The ball around a body on its path, for the broad phase.

#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/query/detail/pair_query.h>

namespace firstcontact::detail {

/// A ball that contains a body at all times, by the path of its centre.
struct BallPath {
  const std::vector<ConstantRatePath>& centre;  ///< One for each piece of the motion.
  double radius = 0.0;                          ///< [m]
};

/// A box that contains the ball throughout the window, all roundings included.
///
/// Between two times the centre stays within min(w^2 l h^2 / 8, 2 l) of the line between its ends.
/// Its acceleration is w^2 l, with l its distance from the axis. h is the time between them.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const BallPath& ball, const TimeWindow& window);

/// [-]  A time before which the two balls are farther apart than the margin; infinite for the whole
/// window.
///
/// It is at least the begin of the window. The function takes a few steps of conservative
/// advancement along the line of centres, then leaves the pair to a search.
[[nodiscard]] double apart_until(const BallPath& A, const BallPath& B, double margin,
                                 const TimeWindow& window);

}  // namespace firstcontact::detail
