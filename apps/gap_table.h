/// @file
/// The gap of a scene over time as a table (CSV).

#pragma once

#include <string>

#include "scene_answer.h"

namespace firstcontact::app {

/// Writes rows of t, time [s], distance [m], lower_bound [m].
///
/// The straight lines between the lower bounds are a proven lower bound of the gap. Rows between
/// samples have no distance.
[[nodiscard]] std::string gap_table(const SceneAnswer& answer);

}  // namespace firstcontact::app
