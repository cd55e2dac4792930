#include <firstcontact/scene/pair_counts.h>

namespace firstcontact {
namespace {

/// The reason for which the pairs are not tested, in words.
const char* reason_text(WhyUntested why) {
  switch (why) {
    case WhyUntested::joined_links:
      return "of links that joints connect";
    case WhyUntested::srdf:
      return "by the SRDF";
    case WhyUntested::allowed_collisions:
      return "by allowed collisions";
    case WhyUntested::held:
      return "of what a link holds";
    case WhyUntested::both_rest:
      return "of which neither moves";
    case WhyUntested::both_scripted:
      return "of which neither is free (they may pass through each other)";
    case WhyUntested::rule:
      break;
  }
  return "by the scene's rules";
}

}  // namespace

std::string pairs_text(std::size_t count) {
  return count == 0 ? "no pair" : std::to_string(count) + (count == 1 ? " pair" : " pairs");
}

std::string describe(const UntestedPairs& pairs) {
  std::string text = std::to_string(pairs.count) + ' ' + reason_text(pairs.why);
  const char* separator = ": ";
  for (const auto& [first, second] : pairs.first) {
    text.append(separator).append(first).append(" and ").append(second);
    separator = ", ";
  }
  if (pairs.count > pairs.first.size() && !pairs.first.empty()) {
    text += ", and " + std::to_string(pairs.count - pairs.first.size()) + " more";
  }
  return text;
}

std::string no_pair_warning(const PairCounts& counts) {
  if (counts.tested > 0) {
    return "";
  }
  std::string text = "no pair is tested: this answer says nothing about contact; ";
  if (counts.untested.empty()) {
    return text + (counts.members == 0 ? "nothing here can touch" : "there is only one body");
  }
  for (const UntestedPairs& pairs : counts.untested) {
    text += (&pairs == &counts.untested.front() ? "" : "; ") + describe(pairs);
  }
  return text;
}

const char* word(WhyUntested why) { return kWhyUntestedWords[static_cast<std::size_t>(why)]; }

}  // namespace firstcontact
