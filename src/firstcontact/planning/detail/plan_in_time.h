/// @file
/// Plans in an environment that moves.

#pragma once

#include <vector>

#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

/// Plans a path as plan_path() does, for a scene with `times`.
[[nodiscard]] PlanResult plan_in_time(const PlanScene& scene, const Configuration& start,
                                      const std::vector<Configuration>& goals, double range,
                                      const PlanOptions& options);

}  // namespace firstcontact::detail
