/// @file
/// Follows two triangles of a search through time, to their contact or to its end.

#pragma once

#include <Eigen/Core>

#include <firstcontact/moving_pairs/detail/convex_leaf.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/query/detail/search_state.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Advances pairs of triangles of a search by certified steps.
class TriangleFollower {
 public:
  explicit TriangleFollower(SearchState& search) : search_(search) {}

  /// Advances a pair of triangles until it is in contact, leaves the step, or another pair is due.
  ///
  /// One of them may stand for a convex set.
  void follow(TriangleEntry entry);

  /// A certified step of a pair as it is placed at t, in the search's instant; 0 where it is within
  /// threshold + tolerance.
  [[nodiscard]] double step_of(const TriangleEntry& entry, double t) const;

  /// The longest certificate of two directions, or of more if both fail.
  ///
  /// They are the direction between the closest points, and the one that the features define, which
  /// stays accurate when the points nearly coincide. Should both fail, any normal and any product
  /// of edges is tried.
  ///
  /// @param t  the time at which the triangles are placed
  /// @param t  where the triangles are placed
  [[nodiscard]] double step(const TriangleEntry& entry, const TrianglePair& triangles,
                            const ClosestFeatures& closest, double t) const;

 private:
  /// Follows a convex set and a triangle, as follow() does.
  void follow_convex(TriangleEntry entry);

  /// The certified step of a convex set and a triangle along the direction n.
  [[nodiscard]] double convex_step(const ConvexLeaf& leaf, const Eigen::Vector3d& n) const;

  /// Whether a pair that comes near at t is in contact soon after, so that SearchLimits::early
  /// saves the steps between.
  ///
  /// Then its contact is found, and it is queued as proven until t.
  ///
  /// @param tau  [-]  its certified step
  [[nodiscard]] bool comes_soon(TriangleEntry entry, double t, double tau);

  /// [m]  An upper bound of the distance of a pair at a state.
  [[nodiscard]] double distance_at(const TriangleEntry& entry, const RelativeState& state) const;

  /// Follows a pair of triangles to its contact or to the end, from t on, in double-double.
  ///
  /// It returns false where that does not decide either.
  [[nodiscard]] bool decide_precisely(const TriangleEntry& entry, double t);

  /// [m]  Rounding of the sum of margin and radii.
  [[nodiscard]] double threshold_rounding() const;

  [[nodiscard]] double step_along(const TriangleEntry& entry, const TrianglePair& triangles,
                                  const ClosestFeatures& closest, const Eigen::Vector3d& n) const;

  SearchState& search_;
};

}  // namespace firstcontact::detail
