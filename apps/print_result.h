/// @file
/// An answer as people read it on a terminal.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pair_text.h"
#include "scene_answer.h"

namespace firstcontact::app {

struct DescribeOptions {
  bool all_pairs = false;  ///< Also a line for each pair.
  bool explain = false;    ///< Also what became of each file.
};

/// Verdict, time, bodies, features, clearance and which pairs were tested, in a few lines.
///
/// @param title  names the scene
[[nodiscard]] std::string describe(std::string_view title, const SceneAnswer& answer,
                                   const DescribeOptions& options);

/// Which pairs were tested, and the first warnings.
[[nodiscard]] std::vector<LabelledLine> last_lines(const SceneAnswer& answer);

/// The verdict and its time: "contact at t = 0.25 (12.5 ms)".
[[nodiscard]] std::string describe_verdict(const SceneAnswer& answer);

/// What sampling saw; empty where nobody asked.
[[nodiscard]] std::string describe_sampling(const SceneAnswer& answer);

/// The first warnings, and how many more there are.
[[nodiscard]] std::vector<std::string> told_warnings(const LoadedScene& loaded);

}  // namespace firstcontact::app
