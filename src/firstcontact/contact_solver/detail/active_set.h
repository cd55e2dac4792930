/// @file
/// Many redundant contacts, of which a few decide the answer.

#pragma once

#include <optional>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// A nut lies on its thread in thousands of contacts, and has six velocities. The laws are solved
/// for those with an impulse; of the rest, those that the answer closes fastest join them, until
/// none closes faster than the tolerance, or than what is left of those chosen: a contact without
/// impulse that does not close meets all laws. So the answer is one of the whole problem, friction
/// included (a cutting-plane method: J. E. Kelley, Journal of SIAM 8 (1960)).
///
/// Ends after some rounds, or where a quarter of all were chosen, with what was found.
///
/// @param rows        of the problem
/// @param projection  where to start from; afterwards nearer to the laws, if it changed
/// @return where the last round was solved, if the laws are met within the tolerance or, without
///         drives, what is enough
[[nodiscard]] std::optional<ProjectionSpace> project_by_active_set(const ContactProblem& problem,
                                                                   const ContactRows& rows,
                                                                   const ProjectionOptions& options,
                                                                   Projection& projection);

}  // namespace firstcontact::detail
