#include <firstcontact/record/detail/joined_steps.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include <firstcontact/record/detail/earlier_impulses.h>

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
  for (RunImpact& impact : whole.impacts) {
    impact.at += first.lasted;
  }
  add_earlier_impulses(first.contacts, whole.contacts);
  for (const RunContact& parted : first.contacts) {
    first.impacts.push_back({first.lasted, parted.bodies, parted.point, parted.impulse});
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
