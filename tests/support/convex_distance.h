/// @file
/// Distance of two convex bodies known by their support points, for exact curved bodies.

#pragma once

#include <functional>

#include <Eigen/Core>

namespace firstcontact::oracle {

/// The point of a convex body that is farthest along a direction.
using Support = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// [m]  lower <= d <= upper, up to rounding; the upper bound is attained by points of the bodies.
struct ConvexDistance {
  double lower = 0.0;
  double upper = 0.0;
};

/// E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance
/// between complex objects in three-dimensional space", IEEE J. Robot. Autom. 4, 1988; the point of
/// a simplex that is nearest to the origin by brute force over its faces.
ConvexDistance convex_distance(const Support& A, const Support& B);

}  // namespace firstcontact::oracle
