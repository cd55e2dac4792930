/// @file
/// Islands that nothing outside acts on: their motion as one body.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

struct IslandState;

/// Whether no body outside acts on an island through contacts, and none of its bodies is held.
[[nodiscard]] bool is_isolated(const IslandState& state, const ContactProblem& problem);

/// Shortens the velocities of an isolated island relative to its motion as one body.
///
/// So it keeps its momenta and has the permitted energy.
///
/// @param allowed  [J]
void shorten_within(const IslandState& state, const ContactProblem& problem, double allowed,
                    ContactSolution& solution);

}  // namespace firstcontact::detail
