/// @file
/// The pairs of an answer as text for a terminal.

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

/// The lines "tested", "ignored" and "left out", with numbers, reasons and names.
[[nodiscard]] std::vector<LabelledLine> pair_lines(const PairCounts& counts);

/// The last lines of a second proof: its pairs, its warnings, and one where no pair is tested.
[[nodiscard]] std::vector<LabelledLine> last_proof_lines(const PairCounts& counts,
                                                         const std::vector<std::string>& warnings);

/// The outcome as text: "none of the 3 pairs that were looked at interpenetrates at any time".
[[nodiscard]] std::string no_penetration_text(const PairCounts& counts);

}  // namespace firstcontact::app
