/// @file
/// Contact problems with many redundant contacts, solved by those that are in the active set.

#pragma once

#include <optional>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Solves a problem with many redundant contacts by an active set of them.
///
/// A nut lies on its screw thread in thousands of contacts, and has six velocities. The laws are
/// solved for the contacts with an impulse. In each round the contacts that the answer closes
/// fastest join them. The rounds end when no contact closes faster than the tolerance or the
/// residual of the set. A contact without impulse that does not close meets all laws. So the answer
/// is one of the whole problem, friction included (a cutting-plane method: J. E. Kelley, Journal of
/// SIAM 8 (1960)).
///
/// The search also ends after kMostRoundsOfDeciding rounds, or when a quarter of all contacts are
/// in the set. Then it returns what it found.
///
/// @param rows        of the problem
/// @param projection  the start; afterwards nearer to the laws, if it changed
/// @return the space of the last round, if the residual is within the tolerance or, without drives
///         and ties, within `enough`
[[nodiscard]] std::optional<ProjectionSpace> project_by_active_set(const ContactProblem& problem,
                                                                   const ContactRows& rows,
                                                                   const ProjectionOptions& options,
                                                                   Projection& projection);

}  // namespace firstcontact::detail
