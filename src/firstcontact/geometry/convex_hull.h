/// @file
/// The convex hull of points.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Makes the convex hull of points, as a closed mesh whose triangles face outwards.
///
/// Its vertices are some of the points, in their order. For points in a plane it is their convex
/// polygon, for points on a line a segment, for one point that point. These meshes enclose nothing.
///
/// Every decision is the exact sign of a determinant: no point lies outside, not even by a
/// rounding. Coordinates below 2^-300 of the greatest count as rounded to that. Takes O(n log n)
/// for most inputs (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex
/// hulls", ACM TOMS 22, 1996).
///
/// @param points  [m]  at least one, finite
/// @throws std::invalid_argument if there is no point, or one is not finite
[[nodiscard]] FIRSTCONTACT_API Mesh convex_hull(const std::vector<Eigen::Vector3d>& points);

/// Makes the hull as a shape; solid where it encloses space. convex_hull numbers its vertices and
/// faces.
///
/// @param radius  [m]  thickens it; >= 0
/// @throws std::invalid_argument as convex_hull and Shape
[[nodiscard]] FIRSTCONTACT_API Shape make_convex_hull(const std::vector<Eigen::Vector3d>& points,
                                                      double radius = 0.0);

}  // namespace firstcontact
