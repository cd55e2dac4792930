/// @file
/// Reads the question of a scene to a planner.

#pragma once

#include <firstcontact/scene/plan_question.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Reads "plan" of a scene that has its bodies and robots.
///
/// @throws ParseError
[[nodiscard]] PlanQuestion read_plan(const JsonValue& value, const Scene& scene,
                                     const JsonReader& read);

}  // namespace firstcontact::detail
