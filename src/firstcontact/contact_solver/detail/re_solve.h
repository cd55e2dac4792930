/// @file
/// Contact problems that are solved again after some of their contacts changed.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

/// Solves a problem again near its contacts that changed or are new.
///
/// These contacts are solved first. The contacts whose bodies then move otherwise by more than the
/// tolerance follow in turn. This ends when none is left, or when `options.sweeps` times as many
/// were solved as there are contacts. Bodies far from them keep their velocity to the last bit, and
/// take no solving. Velocities belong to the impulses, as those before did.
///
/// @param problem  without mechanisms, drives and ties; its guesses are the impulses of the
///         solution before
/// @param before   the solution before: velocities of the first bodies of the problem, and the
///         residual of contacts that did not change
/// @param changed  contacts
/// @returns  the residual is no less than that of any contact; `allowed` is as before
[[nodiscard]] ContactSolution re_solve(const ContactProblem& problem, const ContactSolution& before,
                                       const std::vector<std::size_t>& changed,
                                       const ProjectionOptions& options);

}  // namespace firstcontact::detail
