/// @file
/// How far members move before a pair of them would come too near: the proofs of a plan.

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/haptics/detail/contact_finder.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// A tool and another member, and the least distance of their features where a plan begins.
struct HapticPair {
  std::array<std::size_t, 2> members = {};  ///< The other one, then the tool.
  double gap = 0.0;                         ///< [m]  Infinite where it is beyond the band.
  BoxFront front = {};      ///< Of the members in that order; empty where the roots do as well.
  bool may_be_far = false;  ///< Balls around both are compared first.
};

/// Whether balls around two members are farther apart than a distance, by more than rounding.
[[nodiscard]] bool are_far(const HapticMember& A, const Pose& X_WA, const HapticMember& B,
                           const Pose& X_WB, double distance);

struct ProvenPart {
  double t = 1.0;          ///< [-]  Of the plan: proven free of contact until here.
  double clearance = 0.0;  ///< [m]  Proven: no pair comes closer before. Infinite without pairs.
  bool is_late = false;    ///< The deadline ended a search.
};

/// Proves how much of a plan is free: nothing of it where that brings a wedged pair nearer
/// (kFloorOfGap).
///
/// @param motions  of all members over the plan
[[nodiscard]] ProvenPart prove_plan(
    std::span<const HapticMember> members, std::span<const Motion> motions,
    std::span<HapticPair> pairs, double contact_distance,
    const std::optional<std::chrono::steady_clock::time_point>& deadline, Workspace& workspace,
    FirstContactResult& scratch);

}  // namespace firstcontact::detail
