/// @file
/// The energy of an island whose ties alone act, over a plan.

#pragma once

namespace firstcontact {
struct ContactSolution;
}

namespace firstcontact::detail {

struct IslandState;
struct Plan;

/// Whether an island keeps its energy over a plan as nearly as plans are followed at all. True
/// where anything but gravity and joints of ties acts: then it need not.
///
/// Joints take no energy. Where a loop gets near a singular position, forces turn much within a
/// plan and would give or take some.
[[nodiscard]] bool keeps_tied_energy(const IslandState& state, const Plan& plan,
                                     const ContactSolution& solution, double span);

}  // namespace firstcontact::detail
