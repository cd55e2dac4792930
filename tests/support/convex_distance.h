/// @file
/// Distance of two convex bodies that are given by their support points, for exact curved bodies.

#pragma once

#include <functional>

#include <Eigen/Core>

namespace firstcontact::oracle {

/// Returns the point of a convex body that is farthest along a direction.
using Support = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// [m]  Bounds lower <= d <= upper, up to rounding; points of the bodies attain the upper bound.
struct ConvexDistance {
  double lower = 0.0;
  double upper = 0.0;
};

/// Bounds the distance of two convex bodies by the method of Gilbert, Johnson and Keerthi.
///
/// E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance
/// between complex objects in three-dimensional space", IEEE J. Robot. Autom. 4, 1988. The point of
/// a simplex that is nearest to the origin is found by brute force over the faces.
ConvexDistance convex_distance(const Support& A, const Support& B);

}  // namespace firstcontact::oracle
