/// @file
/// The common normal of an ellipsoid and a convex feature.

#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace firstcontact::detail {

/// An ellipsoid; or a corner or an edge without its thickness: a point or a line.
struct NormalSide {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< [m]  The centre, or any point of the line.
  /// [m^2]  Only for an ellipsoid: its support function is h(n) = sqrt(n . squares n).
  std::optional<Eigen::Matrix3d> squares = {};
  std::optional<Eigen::Vector3d> line = {};  ///< [-]  Unit direction; only for a line.

  /// [m]  Vector from `point` to the point of the ellipsoid farthest along n; zero for the others.
  [[nodiscard]] Eigen::Vector3d farthest(const Eigen::Vector3d& n) const;
};

/// Finds the unit vector along which two convex sets are separated most.
///
/// It is the normal at their closest points, where f(n) = n . (p_B - p_A) - h_A(n) - h_B(-n) is
/// greatest. Newton's method on the sphere finds it, and each step is shortened until f grows. So
/// the result is never worse than the start, apart or overlapping.
///
/// @param sides  at least one is an ellipsoid, at most one a line
/// @param from   [-]  near the normal, from A to B; of any length
[[nodiscard]] Eigen::Vector3d common_normal(const std::array<NormalSide, 2>& sides,
                                            const Eigen::Vector3d& from);

}  // namespace firstcontact::detail
