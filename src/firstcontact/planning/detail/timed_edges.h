/// @file
/// Edges in space and time: for a mover in an environment that moves in a known way.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <firstcontact/edges/detail/edge_search.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/detail/timed_place.h>
#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

/// Checks edges for one thread, and counts them.
class TimedEdges {
 public:
  /// @param plan     with `times`; outlives this
  /// @param options  as EdgeChecker's
  TimedEdges(const PlanScene& plan, const EdgeCheckOptions& options);

  [[nodiscard]] const ConfigurationSpace& space() const { return plan_.space; }
  [[nodiscard]] double duration() const { return plan_.times->duration; }  ///< [s]

  /// [s]  The least time for an edge.
  [[nodiscard]] double travel_time(const Configuration& from, const Configuration& to) const {
    return plan_.space.travel_time(from, to, plan_.times->speeds);
  }

  /// Whether the speeds allow an edge, up to rounding, and it is proven free.
  bool is_free(const TimedPlace& from, const TimedPlace& to);

  /// The answer about a place at its time.
  EdgeFound at(const TimedPlace& place);

  PlanStatistics& counts() { return counts_; }
  [[nodiscard]] PlanStatistics statistics() const;

 private:
  EdgeFound ask(const TimedPlace& from, const TimedPlace& to);

  const PlanScene& plan_;
  EdgeSearch search_;
  PlanStatistics counts_;
  std::map<BodyPair, std::size_t> blocked_;
};

}  // namespace firstcontact::detail
