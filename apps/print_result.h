/// @file
/// An answer as text for a terminal.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pair_text.h"
#include "scene_answer.h"

namespace firstcontact::app {

struct DescribeOptions {
  bool all_pairs = false;  ///< Also a line for each pair.
  bool explain = false;    ///< Also the report on each file.
};

/// Describes an answer in a few lines: verdict, time, bodies, features, clearance and tested pairs.
///
/// @param title  names the scene
[[nodiscard]] std::string describe(std::string_view title, const SceneAnswer& answer,
                                   const DescribeOptions& options);

/// The last lines of an answer: the tested pairs, and the first warnings.
[[nodiscard]] std::vector<LabelledLine> last_lines(const SceneAnswer& answer);

/// The verdict and its time: "contact at t = 0.25 (12.5 ms)".
[[nodiscard]] std::string describe_verdict(const SceneAnswer& answer);

/// The findings of sampling; empty where it was not asked for.
[[nodiscard]] std::string describe_sampling(const SceneAnswer& answer);

/// The first warnings, and the number of the others.
[[nodiscard]] std::vector<std::string> told_warnings(const LoadedScene& loaded);

}  // namespace firstcontact::app
