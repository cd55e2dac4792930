/// @file
/// Plans among surroundings that move.

#pragma once

#include <vector>

#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

/// plan_path() of a scene with `times`.
[[nodiscard]] PlanResult plan_in_time(const PlanScene& scene, const Configuration& start,
                                      const std::vector<Configuration>& goals, double range,
                                      const PlanOptions& options);

}  // namespace firstcontact::detail
