/// @file
/// The gap of two triangles along a direction that may turn.

#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact::detail {

/// [-]  Positions and velocities are products and sums of a few rounded numbers: within this of the
/// sizes of these.
inline constexpr double kGapRounding = 0x1p-48;

/// The corners of one feature, and bounds of their motion.
struct MovingCorners {
  Triangle position;
  Triangle velocity;
  std::size_t count = 3;  ///< Number of corners that differ; a vertex or an edge has fewer.
  double slip = 0.0;      ///< [m per step]  Error of a velocity.
  double bend = 0.0;  ///< [m per step^2]  Acceleration in any direction, besides that of the turn.

  // The turn of a body; else all zero.
  double rate = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double reach = 0.0;  ///< [m]  Bound of the distance of any corner from the pivot, to the end of
                       ///< the step.
  double speed = 0.0;  ///< [m per step]  Bound of the speed of any corner as seen from its body.

  /// Bounds the acceleration of any corner along n(tau), which has turned by `turned`.
  ///
  /// The bound is w |n x u| (w |rho| + 2 |d|) and the bend, errors of the axis included.
  [[nodiscard]] double acceleration(const Eigen::Vector3d& n, double turned) const {
    constexpr double kUp = 1.0 + 0x1p-40;
    const double across = n.cross(axis).norm() + turned + kGapRounding;
    return (rate * across * (rate * reach + 2.0 * speed) + bend * (1.0 + turned)) * kUp;
  }
};

/// The time for which the features stay farther apart than `threshold` along n(tau) = n + tau n'.
///
/// It is the longer of two times: with n' zero, and with the n' that keeps n across the edges of
/// the closest features. advance_deforming() has the derivation.
///
/// @param threshold  [m]  the error of positions included
/// @param n          [-]  unit up to rounding, from A towards B
/// @param closest    chooses n', and has no part in the claim
/// @param enough     no longer time is of interest
[[nodiscard]] double time_apart_along(const MovingCorners& A, const MovingCorners& B,
                                      const ClosestFeatures& closest, double threshold,
                                      const Eigen::Vector3d& n, double enough);

}  // namespace firstcontact::detail
