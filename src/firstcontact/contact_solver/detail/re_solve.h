/// @file
/// Contact problems of which a part changed since they were solved.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

/// Solves a problem again near its contacts that changed or are new.
///
/// These contacts are solved anew. In turn, so are those whose bodies then move otherwise by more
/// than the tolerance, until there are none or `options.sweeps` times as many were solved as there
/// are contacts. Bodies far from them keep their velocity to the last bit, and cost next to
/// nothing. Velocities belong to the impulses, as those before did.
///
/// @param problem  without mechanisms, drives and ties; its guesses are the impulses of the
/// solution
///                 before
/// @param before   the solution before: velocities of the first bodies of the problem, and the
///                 residual of contacts that did not change
/// @param changed  contacts
/// @returns  the residual is no less than that of any contact; what is allowed is as it was before
[[nodiscard]] ContactSolution re_solve(const ContactProblem& problem, const ContactSolution& before,
                                       const std::vector<std::size_t>& changed,
                                       const ProjectionOptions& options);

}  // namespace firstcontact::detail
