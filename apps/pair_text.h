/// @file
/// Which pairs an answer is about, as people read it on a terminal.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/scene/pair_counts.h>

namespace firstcontact::app {

/// A line of an answer.
struct LabelledLine {
  const char* label;
  std::string value;
};

/// "tested", "ignored" and "left out" with how many, by whom and which.
[[nodiscard]] std::vector<LabelledLine> pair_lines(const PairCounts& counts);

/// Those lines of a second proof, its warnings, and one where no pair is tested.
[[nodiscard]] std::vector<LabelledLine> last_proof_lines(const PairCounts& counts,
                                                         const std::vector<std::string>& warnings);

/// "none of the 3 pairs that were looked at interpenetrates at any time"
[[nodiscard]] std::string no_penetration_text(const PairCounts& counts);

}  // namespace firstcontact::app
