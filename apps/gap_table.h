/// @file
/// The gap of a scene over time as a table (CSV).

#pragma once

#include <string>

#include "scene_answer.h"

namespace firstcontact::app {

/// Rows of t, time [s], distance [m], lower_bound [m]. The gap is proven not to be below the
/// straight lines between the lower bounds; rows between samples have no distance.
[[nodiscard]] std::string gap_table(const SceneAnswer& answer);

}  // namespace firstcontact::app
