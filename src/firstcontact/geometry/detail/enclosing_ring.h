/// @file
/// A polygon around a circle, for cylinders and cones.

#pragma once

#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

/// The corners of a polygon that is proven to contain a circle.
struct EnclosingRing {
  std::vector<Eigen::Vector2d> corners;  ///< [m]  Counterclockwise about the origin.
  double excess = 0.0;                   ///< [m]  Bound of a corner's distance from the circle.
};

/// Makes an almost regular polygon with as few corners as the excess permits.
///
/// @param radius  [m]  > 0
/// @param excess  [m]  at least 1e-8 of the radius
EnclosingRing enclosing_ring(double radius, double excess);

}  // namespace firstcontact::detail
