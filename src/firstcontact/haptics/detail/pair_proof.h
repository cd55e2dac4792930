/// @file
/// The proofs of a plan: how far members move before a pair of them comes too near.

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_finder.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// A tool and another member, with the least distance of their features where a plan begins.
struct HapticPair {
  std::array<std::size_t, 2> members = {};  ///< The other member, then the tool.
  double gap = 0.0;                         ///< [m]  Infinite where it is beyond the band.
  /// The front of the members in that order; empty where the roots serve as well.
  BoxFront front = {};
  bool may_be_far = false;  ///< Whether balls around both are compared first.
  double part = 1.0;        ///< [-]  The part of the next plan that a search by triangles tests.
  std::size_t steps = kProofSteps;  ///< [node groups and steps]  The most work of that search.
};

/// Whether balls around two members are farther apart than a distance, by more than rounding.
[[nodiscard]] bool are_far(const HapticMember& A, const Pose& X_WA, const HapticMember& B,
                           const Pose& X_WB, double distance);

/// The part of a plan that is proven.
struct ProvenPart {
  double t = 1.0;  ///< [-]  Time in the plan before which it is proven free of contact.
  /// [m]  Proven lower bound of all distances before t. Infinite without pairs.
  double clearance = 0.0;
  bool is_late = false;  ///< Whether the deadline ended a search.
  /// Whether nothing is proven: a search ended before it knew more, or a wedged pair is held.
  bool is_unproven = false;
};

/// Proves how much of a plan is free. Nothing of it is where that brings a wedged pair nearer
/// (kFloorOfGap).
///
/// @param motions  of all members over the plan
[[nodiscard]] ProvenPart prove_plan(
    std::span<const HapticMember> members, std::span<const Motion> motions,
    std::span<HapticPair> pairs, double contact_distance,
    const std::optional<std::chrono::steady_clock::time_point>& deadline, Workspace& workspace,
    FirstContactResult& scratch);

}  // namespace firstcontact::detail
