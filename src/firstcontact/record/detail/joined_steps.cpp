#include <firstcontact/record/detail/joined_steps.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace firstcontact::detail {

namespace {

/// Puts the pieces of the first part before those of the second.
std::vector<RunPiece> joined_pieces(std::vector<RunPiece> first, std::vector<RunPiece> second,
                                    double first_lasted) {
  for (RunPiece& piece : second) {
    piece.to += first_lasted;
  }
  std::ranges::move(second, std::back_inserter(first));
  return first;
}

/// Adds the impulses of contacts that acted at the end of the first part, too.
void add_impulses(const std::vector<RunContact>& first, std::vector<RunContact>& second) {
  for (RunContact& contact : second) {
    const auto before = std::ranges::find_if(first, [&](const RunContact& other) {
      return other.bodies == contact.bodies && other.feature_A == contact.feature_A &&
             other.feature_B == contact.feature_B;
    });
    if (before != first.end()) {
      contact.impulse += before->impulse;
    }
  }
}

}  // namespace

RunStep joined(RunStep first, RunStep second) {
  RunStep whole = std::move(second);
  const double share = whole.lasted > 0.0 ? whole.lasted / (first.lasted + whole.lasted) : 0.0;
  const auto mean = [&](const auto& a, const auto& b) { return (1.0 - share) * a + share * b; };
  whole.index = first.index;
  whole.clearance = std::min(first.clearance, whole.clearance);
  whole.residual = std::max(first.residual, whole.residual);
  whole.events += first.events;
  for (std::size_t k = 0; k < whole.bodies.size(); ++k) {
    whole.bodies[k].pieces = joined_pieces(std::move(first.bodies[k].pieces),
                                           std::move(whole.bodies[k].pieces), first.lasted);
  }
  for (std::size_t r = 0; r < whole.robots.size(); ++r) {
    std::ranges::transform(first.robots[r].efforts, whole.robots[r].efforts,
                           whole.robots[r].efforts.begin(), mean);
  }
  add_impulses(first.contacts, whole.contacts);
  for (RunImpact& impact : whole.impacts) {
    impact.at += first.lasted;
  }
  whole.impacts.insert(whole.impacts.begin(), first.impacts.begin(), first.impacts.end());
  for (std::size_t k = 0; k < whole.ties.size(); ++k) {
    whole.ties[k].force = mean(first.ties[k].force, whole.ties[k].force);
    whole.ties[k].torque = mean(first.ties[k].torque, whole.ties[k].torque);
  }
  whole.lasted += first.lasted;
  return whole;
}

}  // namespace firstcontact::detail
