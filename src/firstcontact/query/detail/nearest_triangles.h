/// @file
/// The nearest two triangles of two shapes at one instant.

#pragma once

#include <cstdint>
#include <limits>

#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/query/detail/budget_watch.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

struct NearestTriangles {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]  Infinite: none was found.
  ClosestFeatures closest;
  std::uint32_t triangle_A = 0;  ///< In the hierarchies' order.
  std::uint32_t triangle_B = 0;
  UndecidedReason stopped = UndecidedReason::none;  ///< The limit of the budget that ended the
                                                    ///< search; then nothing is claimed.
};

struct NearestTrianglesOptions {
  double within = std::numeric_limits<double>::infinity();  ///< [m]  Triangles that are farther
                                                            ///< apart do not matter.
  /// [-]  The answer may be farther than the nearest by this part of its distance; below 1.
  ///
  /// Surfaces that lie flat on each other have very many pairs that are as near. With slack only
  /// one of them is searched.
  double slack = 0.0;
  WorkBudget budget = {};
};

/// Finds the nearest two triangles, in positions as computed from the state.
///
/// No two are nearer than (1 - slack) `distance`, or none is within `within`.
[[nodiscard]] NearestTriangles nearest_triangles(const MovingPair& pair, const RelativeState& state,
                                                 WorkspaceData& workspace, WorkCount& work,
                                                 const NearestTrianglesOptions& options = {});

}  // namespace firstcontact::detail
