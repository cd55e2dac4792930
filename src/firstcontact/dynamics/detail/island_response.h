/// @file
/// What the contacts of an island make of velocities, in plans and at impacts.

#pragma once

#include <vector>

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/island_state.h>

namespace firstcontact::detail {

/// How exactly problems of an island are solved: to a part of what gravity adds in a step.
[[nodiscard]] ProjectionOptions projection_options(const IslandState& state,
                                                   const ContactProblem& problem);

/// The free velocities of a plan as contacts and drives allow them.
[[nodiscard]] ContactSolution project_plan(const IslandState& state, const ContactProblem& problem);

/// Those after an impact, by project_impact(). Neither adds energy, but for what motors and
/// scripted bodies do.
///
/// @param restitution  of each contact
[[nodiscard]] ContactSolution project_impact_of(const IslandState& state,
                                                const ContactProblem& problem,
                                                const std::vector<double>& restitution);

}  // namespace firstcontact::detail
