/// @file
/// The state that the parts of a search for the contact of two bodies share.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/moving_pairs/detail/pair_instant.h>
#include <firstcontact/query/detail/budget_watch.h>
#include <firstcontact/query/detail/contact_search.h>
#include <firstcontact/query/detail/group_queue.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// A search over a piece of time, window after window.
struct SearchState {
  SearchState(const MovingPair& moving, double begin, double end, const SearchLimits& given,
              WorkspaceData& memory, WorkCount& count)
      : pair(moving),
        limits(given),
        workspace(memory),
        work(count),
        t_begin(begin),
        t_end(end),
        t_last(end),
        // A quarter of the tolerance may be spent on the order of ties, a half on stopping early.
        tie_window(0.25 * given.tolerance / std::max(moving.speed_bound(), 1e-300)),
        queue(moving, tie_window, memory),
        instant(moving, tie_window),
        watch(given.budget),
        all_remembered(given.threshold + given.tolerance >= given.band),
        box_threshold(given.threshold + (all_remembered ? given.tolerance : 0.0)) {}

  [[nodiscard]] std::uint64_t steps() const { return work.node_groups + work.steps; }

  /// [-]  The time after which nothing is of interest.
  [[nodiscard]] double horizon() const { return best.contact ? best.t : t_end; }

  /// Whether a certificate covers the rest, the end included.
  [[nodiscard]] bool covered(double t, double tau) const {
    // Rounded down: at a late time half a unit is a displacement, too.
    return tau > 0.0 &&
           (best.contact ? after(t, tau) > best.t : after(t, tau * (1.0 - 0x1p-50)) >= t_end);
  }

  /// [-]  The time until which all remaining pairs are proven free: the least priority.
  [[nodiscard]] double proven_free() const {
    const double t = queue.empty() ? t_end : queue.top().priority();
    return std::max(t_begin, best.contact ? std::min(t, best.t) : t);
  }

  /// Takes a contact that was found.
  ///
  /// @param slack              [m]  by which it is nearer than it has to be
  /// @param precise_tolerance  [m]  as of the result
  void found(const TriangleEntry& entry, double t, double slack, double precise_tolerance = 0.0) {
    if (best.contact && best.t <= t) {
      return;
    }
    best.contact = true;
    best.t = t;
    best.triangle_A = entry.a;
    best.triangle_B = entry.b;
    best.precise_tolerance = precise_tolerance;
    // Stopping this much earlier keeps the pair within its tolerance.
    stop_window = std::max(0.0, slack) * (1.0 - 0x1p-20) / std::max(pair.speed_bound(), 1e-300);
  }

  const MovingPair& pair;
  const SearchLimits& limits;
  WorkspaceData& workspace;
  WorkCount& work;
  double t_begin;
  double t_end;  ///< End of the window that is searched.
  double t_last;
  double tie_window;
  GroupQueue queue;
  PairInstant instant;
  BudgetWatch watch;
  /// Whether all pairs of triangles within the band at the contact must be among those opened.
  ///
  /// Boxes are then tested against threshold + tolerance, so that no remaining pair of boxes holds
  /// any.
  bool all_remembered;
  double box_threshold;
  double stop_window = 0.0;
  std::uint64_t freed = 0;  ///< Pairs of triangles that came due and were proven free for good.
  bool unresolved = false;
  PieceResult best;
};

}  // namespace firstcontact::detail
