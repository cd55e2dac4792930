/// @file
/// A direction along which two convex polytopes are far apart.

#pragma once

#include <limits>
#include <span>

#include <Eigen/Core>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A convex polytope at its place, in a frame W that both share.
struct PlacedPolytope {
  const PointRows& corners;  ///< [m]  Relative to the centre.
  Eigen::Matrix3d R;         ///< [-]  From its own axes to those of W; any matrix.
  Eigen::Vector3d centre;    ///< [m]  In W.
};

/// A direction, and the gap of A and B along it.
struct Separation {
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  Unit, from A to B.
  /// [m]  The least n . (p_B - p_A) over points of B and A; within 2^-48 of the polytopes' sizes
  /// and distance.
  double gap = 0.0;
};

/// The gaps that are of interest.
struct GapRange {
  double least = 0.0;  ///< [m]  Where no gap is greater than this, any direction will do.
  double enough = std::numeric_limits<double>::infinity();  ///< [m]  No greater gap is asked for.
  double near = 0.9;  ///< [-]  Nor a gap beyond this part of the way from the least to the
                      ///< distance.
};

/// Looks for a direction with nearly the distance as its gap, as far as that exceeds the least.
///
/// Whatever the direction, its gap is that of the points.
///
/// Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the
/// distance between complex objects in three-dimensional space", IEEE J. Robot. Autom. 4, 1988.
///
/// @param n  [-]  unit; the beginning of the search
[[nodiscard]] FIRSTCONTACT_API Separation separate(const PlacedPolytope& A, const PlacedPolytope& B,
                                                   const Eigen::Vector3d& n,
                                                   const GapRange& range = {});

/// Looks for such a direction for A and B at several places each: the gap is the least of theirs.
///
/// Places of the same index belong together. A body with a single place keeps it.
///
/// @param A, B  1 or 3 places of the same corners
[[nodiscard]] FIRSTCONTACT_API Separation separate(std::span<const PlacedPolytope> A,
                                                   std::span<const PlacedPolytope> B,
                                                   const Eigen::Vector3d& n,
                                                   const GapRange& range = {});

}  // namespace firstcontact
