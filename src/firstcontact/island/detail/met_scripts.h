/// @file
/// The scripts that an island meets in a step, and those that crush it where it jams.

#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

struct IslandState;
struct ManifoldPoint;

/// Scripted bodies that move and touch an island, are in the way of a plan, or pull at a tie.
class MetScripts {
 public:
  /// Notes the scripts that touch the island, and how far they close there in the step by
  /// themselves.
  void meet(IslandState& state, const ManifoldPoint& touch);

  /// Notes the scripts that pull at ties.
  void meet_ties(IslandState& state);

  /// Starts the notes about the scripts that stop a plan.
  void begin_plan() { in_plan_.clear(); }
  void meet_in_plan(IslandState& state, const ManifoldPoint& touch);

  /// Whether any of these scripts had to wait before.
  [[nodiscard]] bool try_again() const { return try_again_; }

  /// The bodies that close fastest where the last plan was stopped, or else at all touches that the
  /// island met. A body that moves along a contact, or away, crushes nothing.
  [[nodiscard]] std::vector<std::size_t> crushing() const;

 private:
  using Ways = std::map<std::size_t, double>;  // [m]  For each body how far it closes.

  void add(const IslandState& state, std::size_t body, double closing, Ways& ways);
  void add(IslandState& state, const ManifoldPoint& touch, Ways& ways);

  Ways met_;
  Ways in_plan_;
  bool try_again_ = false;
};

}  // namespace firstcontact::detail
