/// @file
/// Writes what a check of robots answered.

#pragma once

#include <firstcontact/text/json_tree.h>

namespace firstcontact {
struct LoadedScene;
struct RobotCheckResult;
}  // namespace firstcontact

namespace firstcontact::detail {

/// The members of a result up to those that every scene has: verdict to enclosure_error, limits and
/// warnings.
[[nodiscard]] JsonObject robot_result(const LoadedScene& loaded, const RobotCheckResult& result,
                                      bool all_pairs);

}  // namespace firstcontact::detail
