/// @file
/// Nearly closest points of two convex sets, and a direction that nearly separates them best.

#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A convex core at its place, in a frame that both of a pair share.
struct PlacedConvex {
  const ConvexCore& core;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();   ///< [-]  From its axes to the frame's.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  The origin of the core's frame.

  [[nodiscard]] Eigen::Vector3d to_own_axes(const Eigen::Vector3d& n) const {
    return R.transpose() * n;
  }
  [[nodiscard]] Eigen::Vector3d to_frame(const Eigen::Vector3d& p) const { return centre + R * p; }
};

/// The beginning of a search for closest points: the end of the last search of a pair.
///
/// It determines how long the search takes. The points are points of both cores, in the cores' own
/// frames. A guess serves the same two cores at any places, and no others.
struct ConvexGuess {
  std::size_t count = 0;  ///< 0 to 4.
  std::array<Eigen::Vector3d, 4> p_A;
  std::array<Eigen::Vector3d, 4> p_B;
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  From A to B; where count is 0.
};

/// When a search for closest points may end.
struct ConvexWanted {
  double least = -std::numeric_limits<double>::infinity();  ///< [m]
  /// [-]  The search ends where the gap beyond `least` is this part of the distance beyond it.
  double near = 1.0;
  double close = 0.0;  ///< [m]  The search ends where points are as near as that.
};

/// A point of each core, and a direction.
struct ConvexClosest {
  double distance = 0.0;  ///< [m]  |p_B - p_A|
  Eigen::Vector3d p_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< [-]  Unit, from A to B; zero: none is known.
  double gap = -std::numeric_limits<double>::infinity();  ///< [m]  Along n, rounded; no claim.
  int rounds = 0;
};

/// Looks for the closest points of two convex cores.
///
/// Claims: p_A lies near A's core, placed by R and centre as they are. It is within 2^-47 of the
/// sum of |p_A - centre| and A's reach. The same holds for p_B. So the distance is an upper bound
/// of that of the cores, up to as much. How near the distance is to the least one, and how well n
/// separates, is not claimed. For a certificate along n see advance_convex().
///
/// Derivation: each point is a convex combination of up to four support points
/// (ConvexCore::support_point) with shares >= 0. Turning and summing up four products rounds by
/// less than 40 2^-53 of their sizes.
///
/// Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the
/// distance between complex objects in three-dimensional space", IEEE J. Robot. Autom. 4, 1988. The
/// direction of a triangle of differences is its normal, which stays accurate where the points
/// nearly coincide.
///
/// @param guess  for the same two cores; receives the beginning of the next search
[[nodiscard]] FIRSTCONTACT_API ConvexClosest closest_points(const PlacedConvex& A,
                                                            const PlacedConvex& B,
                                                            const ConvexWanted& wanted,
                                                            ConvexGuess& guess);

}  // namespace firstcontact
