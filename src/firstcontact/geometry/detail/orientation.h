/// @file
/// The side of a plane on which a point lies, exactly.

#pragma once

#include <Eigen/Core>

namespace firstcontact::detail {

/// Computes the sign of det(b - a, c - a, d - a): positive where a, b, c turn to the left as seen
/// from d.
///
/// Method: a filter, then exact expansions (J. R. Shewchuk, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", Discrete Comput. Geom. 18, 1997).
///
/// @param a  coordinates are multiples of 2^-300 and at most 1 in size; so are those of b, c, d
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// Computes the sign of det(b - a, c - a) in the plane: positive where a, b, c turn to the left.
int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace firstcontact::detail
