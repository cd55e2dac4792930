/// @file
/// The energy over a plan of an island on which only ties act.

#pragma once

namespace firstcontact {
struct ContactSolution;
}

namespace firstcontact::detail {

struct IslandState;
struct Plan;

/// Whether an island keeps its energy over a plan, to the precision of plans. True where anything
/// but gravity and joints of ties acts, as its energy may change then.
///
/// Joints take no energy. Where a loop gets near a singular position, forces turn much within a
/// plan and would give or take some.
[[nodiscard]] bool keeps_tied_energy(const IslandState& state, const Plan& plan,
                                     const ContactSolution& solution, double span);

}  // namespace firstcontact::detail
