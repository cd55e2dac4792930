/// @file
/// Triangles whose corners are on one line.

#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact {

/// Whether the corners of a triangle are on one line, but for rounding. Corners may coincide.
inline bool is_needle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  constexpr double kFlat = 1e-10;  // [-]  Greater than the rounding of moved corners.
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (c - b).squaredNorm()});
  return u.cross(v).squaredNorm() <= kFlat * kFlat * longest * longest;
}

}  // namespace firstcontact
