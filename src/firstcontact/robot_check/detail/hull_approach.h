/// @file
/// The approach of two convex hulls; a search for the contact of shapes begins after it.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// A convex set that holds a shape, except for the shape's thickening. Refers to the corners.
struct ShapeHull {
  ConvexCore core;     ///< Core in the frame of the hierarchy's centre.
  double error = 0.0;  ///< [m]  Thickness that the set needs to hold the shape.
};

/// [m]  The corners of ShapeBounds, from the centre of the shape's hierarchy; none where the shape
/// deforms.
[[nodiscard]] std::vector<Eigen::Vector3d> hull_corners(const Shape& shape);

/// The hull of a shape in a pair; the set itself where the shape is treated as one.
///
/// @param corners  hull_corners() of the shape; at least one
[[nodiscard]] ShapeHull hull_of(const Shape& shape, const Shape& partner,
                                const std::vector<Eigen::Vector3d>& corners);

/// The time until which two hulls are proven farther apart than a threshold, from the begin of a
/// window.
///
/// It ends where they are nearly that near, or come near too slowly for few steps.
///
/// @param motion     relative motion of the shapes' hierarchies; pieces of it are entered
/// @param threshold  [m]  thickenings of the shapes included
[[nodiscard]] double hulls_apart_until(const ShapeHull& A, const ShapeHull& B, PairMotion& motion,
                                       const TimeWindow& window, double threshold);

}  // namespace firstcontact::detail
