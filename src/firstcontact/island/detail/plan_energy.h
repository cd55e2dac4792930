/// @file
/// The energy of an island over a plan.

#pragma once

namespace firstcontact {
struct ContactProblem;
struct ContactSolution;
}  // namespace firstcontact

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

/// Whether contacts add no energy over a plan, to the precision of plans. True where ties, forces,
/// robots, belts or scripts may add some.
///
/// It looks at all of the energy, that of displacements too, where a body turns far. The planner
/// limits the work of contacts in every plan.
[[nodiscard]] bool contacts_add_no_energy(const IslandState& state, const Plan& plan,
                                          const ContactProblem& problem, double span);

}  // namespace firstcontact::detail
