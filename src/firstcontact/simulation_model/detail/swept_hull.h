/// @file
/// The convex hull of a body over a move.
///
/// For many pairs that slide or rest on each other, a plane that goes with one of them proves that
/// they stay apart.

#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>

namespace firstcontact {
struct ShapeBounds;
}

namespace firstcontact::detail {

struct Move;
struct SimBody;

/// A body's hull over a part of a move.
struct SweptHull {
  /// @param X_WB      pose at the begin of the move
  /// @param from, to  [-]  Shares of the move, 0 <= from < to <= 1.
  SweptHull(const SimBody& body, const Pose& X_WB, const Move& move, double from = 0.0,
            double to = 1.0);

  const ShapeBounds* bounds;
  std::array<Eigen::Matrix3d, 3> R_WB;  ///< At the begin of the part, in its middle and at its end.
  Eigen::Vector3d p_BC;                 ///< [m]  Centre of mass in the body.
  Eigen::Vector3d p_WC;                 ///< [m]  Centre of mass at the begin.
  Eigen::Vector3d translation;          ///< [m]
  double rate;                          ///< [rad]  Turn over the part.
  double reach;                         ///< [m]  Reach of the body from C.
  double thickness;                     ///< [m]  Thickness around the hull.
};

/// The normal, in the world at the begin, of a plane that moves with A and that B stays away from.
///
/// B stays farther from the plane than a distance [m] over the same part of their moves. Without a
/// normal nothing is known of the pair.
///
/// Derivation: x is the place of a point of B from C of A. V is the relative speed of the centres.
/// The point's velocity is at most V + w_B r_B, its acceleration w_B^2 r_B, its jerk w_B^3 r_B. As
/// seen from A, which turns at the rate w, each derivative d/dt becomes d/dt - w x. So there
///   |jerk| <= w_B^3 r_B + 3 w w_B^2 r_B + 3 w^2 (V + w_B r_B) + w^3 |x|.
/// The point is within |jerk| / 124 of the parabola through three places of its way, by
/// interpolation: max |t (t - 1/2) (t - 1)| / 6 = 1 / 124.7. The parabola is in the hull of its
/// control points.
///
/// @param n  [-]  unit, from A to B, world; first direction of the search
[[nodiscard]] std::optional<Eigen::Vector3d> plane_between(const SweptHull& A, const SweptHull& B,
                                                           double distance,
                                                           const Eigen::Vector3d& n);

/// Whether there is such a plane.
[[nodiscard]] inline bool stays_apart(const SweptHull& A, const SweptHull& B, double distance,
                                      const Eigen::Vector3d& n) {
  return plane_between(A, B, distance, n).has_value();
}

}  // namespace firstcontact::detail
