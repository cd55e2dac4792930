/// @file
/// Contact problems of which a part changed since they were solved.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/dynamics/contact_problem.h>

namespace firstcontact::detail {

/// Solves a problem again, near its contacts that changed or are new. What is far from them keeps
/// its velocity to the last bit. Velocities belong to the impulses, as those before did.
///
/// @param problem  without mechanisms and drives; its guesses are the impulses of the solution
///                 before
/// @param before   the velocities of the solution before, of the first bodies of the problem
/// @param changed  contacts
[[nodiscard]] ContactSolution project_again(const ContactProblem& problem,
                                            const std::vector<ContactBody>& before,
                                            const std::vector<std::size_t>& changed,
                                            const ProjectionOptions& options);

}  // namespace firstcontact::detail
