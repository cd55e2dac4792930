/// @file
/// Writes what a check of robots answered.

#pragma once

#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// The members of a result up to those that every scene has: verdict to enclosure_error, limits and
/// warnings.
[[nodiscard]] JsonObject robot_result(const LoadedScene& loaded, const RobotCheckResult& result,
                                      bool all_pairs);

}  // namespace firstcontact::detail
