/// @file
/// A box and a convex polytope around a shape, to tell quickly that it is far from others.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct Hierarchy;

/// Points, one per row [m]: sums run along the columns.
using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// A box and a polytope around all triangles, without the thickening; in the body frame. They
/// hold the triangles of a shape that deforms at all times of the step.
struct ShapeBounds {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< [m]  Of the box.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();      ///< [-]  Of the box, one per row.
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< [m]
  double reach = 0.0;                                      ///< [m]  Of the triangles, from there.
  PointRows corners;   ///< [m]  From the centre; the triangles are in their convex hull.
  double error = 0.0;  ///< [m]  Of the corners: the hull has to be thickened by it.
};

/// Finds the bounds of a shape.
///
/// Each vertex of a shape that deforms moves on a line, seen from its centre. So the hull of the
/// places of all vertices at both ends holds the shape throughout the step.
///
/// The box is the smallest of those with the axes of the body frame and of the root's boxes. The
/// corners are those of the convex hull where it has few, else those of the box.
[[nodiscard]] FIRSTCONTACT_API ShapeBounds shape_bounds(const Hierarchy& hierarchy);

}  // namespace firstcontact
