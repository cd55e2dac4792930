/// @file
/// A box and a convex polytope around a shape, to prove quickly that it is far from others.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct Hierarchy;

/// Points, one per row [m]: sums run along the columns.
using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// A box and a polytope around all triangles, without the thickening; in the body frame.
///
/// For a shape that deforms they contain the triangles at all times of the step.
struct ShapeBounds {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< [m]  Centre of the box.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();      ///< [-]  Axes of the box, one per row.
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< [m]
  double reach = 0.0;  ///< [m]  Bound of the triangles' distance from the centre.
  PointRows corners;   ///< [m]  Corners from the centre; their convex hull contains the triangles.
  double error = 0.0;  ///< [m]  Error of the corners, by which to thicken the hull.
};

/// Finds the bounds of a shape.
///
/// Each vertex of a shape that deforms moves on a line relative to the centre. So the hull of the
/// places of all vertices at both ends contains the shape throughout the step.
///
/// The box is the smallest of those with the axes of the body frame and of the root's boxes. The
/// corners are those of the convex hull where it has few, else those of the box.
[[nodiscard]] FIRSTCONTACT_API ShapeBounds shape_bounds(const Hierarchy& hierarchy);

}  // namespace firstcontact
