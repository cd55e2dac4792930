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

/// Whether many moving bodies touch at many places: such problems are solved less exactly.
[[nodiscard]] bool is_heap(const IslandState& state, std::size_t contacts);

/// [m/s]  The tolerance of problems of few contacts.
[[nodiscard]] double exact_tolerance(const IslandState& state);

/// Chooses the tolerances of an island's problems: a fraction of what gravity adds in a step.
[[nodiscard]] ProjectionOptions projection_options(const IslandState& state,
                                                   const ContactProblem& problem);

/// The velocities of a plan.
struct PlanSolution {
  ContactSolution velocities;
  bool is_limited = false;  ///< Whether they are shorter than contacts require.
  /// Whether contacts have less friction than they should; `residual` shows by how much.
  bool slips = false;
  /// Whether motors without bound had to yield. Their impulses, and those of contacts, are then far
  /// larger than any motion needs.
  bool yields = false;
};

/// [J]  Computes the energy of the free velocities of a plan.
[[nodiscard]] double free_energy(const IslandState& state, const ContactProblem& problem);

/// Projects the free velocities of a plan on its contacts and drives. Where scripts wedge bodies,
/// and only friction leaves no solution, contacts slip. They do so in the first few plans of a
/// step.
///
/// @param free  [J]  Bound of the energy that contacts leave; by default free_energy()
[[nodiscard]] PlanSolution project_plan(IslandState& state, const ContactProblem& problem,
                                        std::optional<double> free = std::nullopt);

/// Projects the velocities that move bodies along a plan, as exactly as its displacements need.
/// Contacts slip as in project_plan().
[[nodiscard]] PlanSolution project_way(IslandState& state, const ContactProblem& problem,
                                       double span);

/// Solves a plan that differs from another one only in changed contacts, by re_solve(). Returns
/// nothing where that saves no time, or leaves too large a residual.
[[nodiscard]] std::optional<PlanSolution> project_plan_again(
    const IslandState& state, const ContactProblem& problem, const PlanSolution& before,
    const std::vector<std::size_t>& changed);

/// Computes the velocities after an impact, by the scene's law for impacts at the same time.
///
/// @param pairs  the bodies of each contact
[[nodiscard]] ContactSolution project_impact_of(const IslandState& state,
                                                const ContactProblem& problem,
                                                const std::vector<BodyPair>& pairs);

/// [m/s]  The speed below which impacts do not bounce.
[[nodiscard]] double slowest_bounce(const IslandState& state);

/// [-]  Computes the restitution of a contact that meets with these velocities.
[[nodiscard]] double restitution_of(const IslandState& state, const BodyPair& pair,
                                    const ContactPoint& contact,
                                    const std::vector<ContactBody>& bodies);

/// Computes the velocities after an impact of all contacts at once, by project_impact(). It adds no
/// energy, except by motors and scripted bodies.
///
/// @param restitution  of each contact
[[nodiscard]] ContactSolution project_simultaneous_impact(const IslandState& state,
                                                          const ContactProblem& problem,
                                                          const std::vector<double>& restitution);

/// Whether a problem has a solution that was found.
[[nodiscard]] bool is_solved(const IslandState& state, const ContactSolution& solution);

/// Whether all velocities and impulses of a solution are finite.
[[nodiscard]] bool is_finite(const ContactSolution& solution);

/// Computes the impulses of other bodies on each robot.
///
/// They act at the place of the contact halfway through the span. For a free partner that is the
/// partner's point, so that momenta are kept, the moment about the origin too. They are not known
/// where velocities were limited.
///
/// @param span  [s]  over which they act; 0 at an impact
[[nodiscard]] std::vector<OuterImpulse> outer_impulses(const ContactProblem& problem,
                                                       const PlanSolution& solution,
                                                       const ProblemBodies& bodies,
                                                       std::size_t robots, double span);

}  // namespace firstcontact::detail
