/// @file
/// Impacts at the same time, one pair after another.

#pragma once

#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/many_bodies/pair_rules.h>

namespace firstcontact::detail {

struct IslandState;

/// Computes the velocities after an impact in which pairs answer one after another.
///
/// The pair that closes fastest is next, by project_impact(). Pairs that close as fast, to one part
/// in a million, answer at the same time. Where they move the same body, project_impact() takes
/// them together. So the order of pairs changes nothing. This goes on until no pair closes
/// faster than an impact that does not bounce, or faster than a very small speed. Then all contacts
/// together hold the pairs that still close. Pairs without restitution have no turn: they hold in
/// each answer, as if they were one body.
///
/// Each answer keeps momentum and adds no energy, so the sum does neither. A row of equal balls in
/// touch passes an impact on to its last ball (Newton's cradle; V. Acary, B. Brogliato, "Concerning
/// the multiple impacts modelling in the Newton's cradle", INRIA report 5064 (2003)).
///
/// The number of answers is bounded, by a number for each pair: pairs may pass an impact to and
/// fro.
///
/// @param pairs  the bodies of each contact
[[nodiscard]] ContactSolution project_sequential_impacts(const IslandState& state,
                                                         const ContactProblem& problem,
                                                         const std::vector<BodyPair>& pairs);

}  // namespace firstcontact::detail
