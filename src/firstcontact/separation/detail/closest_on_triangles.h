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

/// The closest points of two triangles, approximately.
///
/// The distance is an upper bound up to the rounding of a few sums. It never proves that triangles
/// are apart. Degenerate triangles count as edges and points.
[[nodiscard]] PointPair closest_estimate(const TrianglePoints& A, const TrianglePoints& B);

/// A point of the triangle close to p: a convex combination of its corners, up to the rounding of
/// a few sums, however thin the triangle is.
[[nodiscard]] Eigen::Vector3d point_on_triangle(const TrianglePoints& triangle,
                                                const Eigen::Vector3d& p);

}  // namespace firstcontact::detail
