/// @file
/// The verifier's own closest points of two triangles.

#pragma once

#include <array>

#include <Eigen/Core>

namespace firstcontact::detail {

using TrianglePoints = std::array<Eigen::Vector3d, 3>;

/// A point of each of two triangles.
struct PointPair {
  Eigen::Vector3d on_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_B = Eigen::Vector3d::Zero();
  double distance = 0.0;  ///< [m]
};

/// About the closest points: an upper bound of the distance up to the rounding of a few sums, never
/// a proof that triangles are apart. Degenerate triangles are edges and points.
[[nodiscard]] PointPair closest_estimate(const TrianglePoints& A, const TrianglePoints& B);

/// A point of the triangle close to p: a convex combination of its corners, up to the rounding of
/// a few sums, however thin the triangle is.
[[nodiscard]] Eigen::Vector3d point_on_triangle(const TrianglePoints& triangle,
                                                const Eigen::Vector3d& p);

}  // namespace firstcontact::detail
