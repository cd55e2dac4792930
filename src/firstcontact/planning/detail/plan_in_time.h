/// @file
/// Plans in an environment that moves.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/detail/timed_place.h>
#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

class TimedEdges;

/// Describes the pair that blocks a place at its time, as the other describe_blocked() does.
///
/// @param options  of the edges
[[nodiscard]] std::string describe_blocked(const PlanScene& scene, const EdgeCheckOptions& options,
                                           TimedEdges& edges, const TimedPlace& place,
                                           const std::string& what);

/// Plans a path as plan_path() does, for a scene with `times`.
[[nodiscard]] PlanResult plan_in_time(const PlanScene& scene, const Configuration& start,
                                      const std::vector<Configuration>& goals, double range,
                                      const PlanOptions& options);

}  // namespace firstcontact::detail
