/// @file
/// What a plan without a path prints as JSON.

#pragma once

#include <string>

namespace firstcontact {
struct PlanResult;
struct ScenePlan;
}  // namespace firstcontact

namespace firstcontact::app {

/// Writes one object on one line: the verdict, the pairs most in the way, and what was spent.
[[nodiscard]] std::string failed_plan_json(const ScenePlan& scene, const PlanResult& result);

}  // namespace firstcontact::app
