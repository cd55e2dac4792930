#include <firstcontact/many_bodies/scene_result.h>

#include <utility>

namespace firstcontact {
namespace {

/// The sorting key of a closest approach: its distance, for pairs that touch the time.
std::pair<double, double> closeness(const ClosestApproach& found) {
  const bool touch = found.reason == UndecidedReason::none && found.lower_bound == 0.0;
  return {touch ? 0.0 : found.distance, found.t};
}

}  // namespace

std::optional<std::size_t> deciding_pair(std::span<const PairAnswer> pairs) {
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].verdict != Verdict::free && (!first || decides_before(pairs[k], pairs[*first]))) {
      first = k;
    }
  }
  return first;
}

std::optional<std::size_t> closest_pair(std::span<const PairAnswer> pairs) {
  std::optional<std::size_t> closest;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].closest &&
        (!closest || closeness(*pairs[k].closest) < closeness(*pairs[*closest].closest))) {
      closest = k;
    }
  }
  return closest;
}

}  // namespace firstcontact
