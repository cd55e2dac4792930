/// @file
/// The response of velocities to the contacts of an island, in plans and at impacts.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {

struct IslandState;

/// Whether many bodies that move touch at many places: such problems are solved less exactly.
[[nodiscard]] bool is_heap(const IslandState& state, std::size_t contacts);

/// [m/s]  To which problems of few contacts are solved.
[[nodiscard]] double exact_tolerance(const IslandState& state);

/// How exactly problems of an island are solved: to a part of what gravity adds in a step.
[[nodiscard]] ProjectionOptions projection_options(const IslandState& state,
                                                   const ContactProblem& problem);

/// The velocities of a plan.
struct PlanSolution {
  ContactSolution velocities;
  bool is_limited = false;  ///< They are shorter than contacts would have them.
  bool slips = false;       ///< Contacts have less friction than they should; `residual` tells.
};

/// [J]  Of the free velocities of a plan.
[[nodiscard]] double free_energy(const IslandState& state, const ContactProblem& problem);

/// The free velocities of a plan as contacts and drives allow them. Where scripts wedge bodies and
/// friction alone leaves no solution, contacts slip, in the first few plans of a step.
///
/// @param free  [J]  Contacts may not lead beyond it; by default free_energy()
[[nodiscard]] PlanSolution project_plan(IslandState& state, const ContactProblem& problem,
                                        std::optional<double> free = std::nullopt);

/// Velocities that lead along the way of a plan: as exactly as its displacements need. They slip as
/// those of project_plan() do.
[[nodiscard]] PlanSolution project_way(IslandState& state, const ContactProblem& problem,
                                       double span);

/// Those of a plan that is like another but for contacts that changed, by re_solve(). Nothing
/// where that is not worth while, or leaves too much.
[[nodiscard]] std::optional<PlanSolution> project_plan_again(
    const IslandState& state, const ContactProblem& problem, const PlanSolution& before,
    const std::vector<std::size_t>& changed);

/// Those after an impact, by the scene's law for impacts at the same time.
///
/// @param pairs  the bodies of each contact
[[nodiscard]] ContactSolution project_impact_of(const IslandState& state,
                                                const ContactProblem& problem,
                                                const std::vector<BodyPair>& pairs);

/// [m/s]  Impacts that are slower do not bounce.
[[nodiscard]] double slowest_bounce(const IslandState& state);

/// [-]  The restitution of a contact that meets with these velocities.
[[nodiscard]] double restitution_of(const IslandState& state, const BodyPair& pair,
                                    const ContactPoint& contact,
                                    const std::vector<ContactBody>& bodies);

/// Those after an impact of all contacts at once, by project_impact(). It adds no energy, but for
/// what motors and scripted bodies do.
///
/// @param restitution  of each contact
[[nodiscard]] ContactSolution project_simultaneous_impact(const IslandState& state,
                                                          const ContactProblem& problem,
                                                          const std::vector<double>& restitution);

/// Whether a problem has a solution that was found.
[[nodiscard]] bool is_solved(const IslandState& state, const ContactSolution& solution);

/// The impulses on each robot of what is not of it.
///
/// They act where the contact is halfway through the span. Where the other body is free it is that
/// body's point, so that what the one gets the other one loses, the moment about the origin too.
/// They are not known where velocities were limited.
///
/// @param span  [s]  over which they act; 0 at an impact
[[nodiscard]] std::vector<OuterImpulse> outer_impulses(const ContactProblem& problem,
                                                       const PlanSolution& solution,
                                                       const ProblemBodies& bodies,
                                                       std::size_t robots, double span);

}  // namespace firstcontact::detail
