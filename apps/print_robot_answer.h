/// @file
/// The answer of a scene with robots as people read it on a terminal.

#pragma once

#include <string>

#include "scene_answer.h"

namespace firstcontact::app {

/// Links, contacts, clearance, intervals and warnings, in a few lines.
///
/// @param all_pairs  also a line for each pair
[[nodiscard]] std::string describe_robots(const SceneAnswer& answer, bool all_pairs);

}  // namespace firstcontact::app
