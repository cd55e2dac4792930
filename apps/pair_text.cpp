#include "pair_text.h"

#include <utility>

#include <fmt/core.h>

namespace firstcontact::app {

std::vector<LabelledLine> pair_lines(const PairCounts& counts) {
  std::vector<LabelledLine> lines = {{"tested", pairs_text(counts.tested)}};
  for (const UntestedPairs& pairs : counts.untested) {
    lines.push_back({is_ignored(pairs.why) ? "ignored" : "left out", describe(pairs)});
  }
  return lines;
}

std::vector<LabelledLine> last_proof_lines(const PairCounts& counts,
                                           const std::vector<std::string>& warnings) {
  std::vector<LabelledLine> lines = pair_lines(counts);
  for (const std::string& warning : warnings) {
    lines.push_back({"warning", warning});
  }
  if (std::string warning = no_pair_warning(counts); !warning.empty()) {
    lines.push_back({"warning", std::move(warning)});
  }
  return lines;
}

std::string no_penetration_text(const PairCounts& counts) {
  switch (counts.tested) {
    case 0:
      return "no pair was looked at";
    case 1:
      return "the one pair that was looked at interpenetrates at no time";
    default:
      return fmt::format("none of the {} pairs that were looked at interpenetrates at any time",
                         counts.tested);
  }
}

}  // namespace firstcontact::app
