/// @file
/// An answer as people read it on a terminal.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene_answer.h"

namespace firstcontact::app {

/// Verdict, time, bodies, features and clearance, in a few lines.
///
/// @param title      names the scene
/// @param all_pairs  also a line for each pair
[[nodiscard]] std::string describe(std::string_view title, const SceneAnswer& answer,
                                   bool all_pairs);

/// The verdict and its time: "contact at t = 0.25 (12.5 ms)".
[[nodiscard]] std::string describe_verdict(const SceneAnswer& answer);

/// What sampling saw; empty where nobody asked.
[[nodiscard]] std::string describe_sampling(const SceneAnswer& answer);

/// The first warnings, and how many more there are.
[[nodiscard]] std::vector<std::string> told_warnings(const LoadedScene& loaded);

}  // namespace firstcontact::app
