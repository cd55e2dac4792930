#include <firstcontact/haptics/detail/pair_proof.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/query/detail/front_query.h>
#include <firstcontact/query/distance.h>

namespace firstcontact::detail {
namespace {

struct HeldApart {
  double margin = 0.0;     // [m]
  double tolerance = 0.0;  // [m]
};

/// A pair that is near already is held to a share of its gap, so that it can slide and part.
HeldApart held_apart(double gap, double contact_distance) {
  if (gap > kFreeGap * contact_distance) {
    return {contact_distance, kFoundWithin * contact_distance};
  }
  const double margin = std::max(
      kShareOfGap * gap, std::min(kLeastHeldGap * contact_distance, kShareOfJammedGap * gap));
  return {margin, 0.5 * (gap - margin)};
}

}  // namespace

ProvenPart prove_plan(std::span<const HapticMember> members, std::span<const Motion> motions,
                      std::span<HapticPair> pairs, double contact_distance,
                      const std::optional<std::chrono::steady_clock::time_point>& deadline,
                      Workspace& workspace, FirstContactResult& scratch) {
  ProvenPart proven{.clearance = std::numeric_limits<double>::infinity()};
  for (HapticPair& pair : pairs) {
    const auto [other, tool] = pair.members;
    const HeldApart held = held_apart(pair.gap, contact_distance);
    FirstContactOptions options{
        .margin = held.margin, .tolerance = held.tolerance, .contacts = ContactState::none};
    options.budget.deadline = deadline;
    options.budget.steps = kProofSteps;
    const MovingShape A{members[other].shape, motions[other]};
    const MovingShape B{members[tool].shape, motions[tool]};
    if (pair.front.is_empty()) {
      first_contact(A, B, workspace, options, scratch);
    } else {
      first_contact_by_front(pair.front, A, B, workspace, options, scratch);
      pair.front.count_work(scratch.work.node_groups + scratch.work.steps);
    }
    if (scratch.verdict != Verdict::free) {
      proven.t = std::min(proven.t, scratch.t);
      proven.is_late = proven.is_late || scratch.reason == UndecidedReason::deadline;
    }
    proven.clearance = std::min(proven.clearance, held.margin);
  }
  const auto comes_nearer = [&](const HapticPair& pair) {
    if (!(pair.gap < kFloorOfGap * contact_distance)) {
      return false;
    }
    const std::size_t other = pair.members[0];
    const std::size_t tool = pair.members[1];
    const auto distance_at = [&](double t) {
      return distance({members[other].shape, motions[other]}, {members[tool].shape, motions[tool]},
                      t, workspace)
          .distance;
    };
    // Rounding alone must not hold a tool that slides or rests.
    const double slack =
        kSlackOfFloor * pair.gap + kRoundingOfPieces * (members[other].reach + members[tool].reach);
    return distance_at(proven.t) < distance_at(0.0) - slack;
  };
  if (proven.t > 0.0 && std::ranges::any_of(pairs, comes_nearer)) {
    proven.t = 0.0;
  }
  return proven;
}

}  // namespace firstcontact::detail
