/// @file
/// Contact problems in the space of impulses: sweeps over contacts, one after the other.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Solves each drive and contact in turn for the impulse that meets its own laws, there and back
/// (projected Gauss-Seidel). Successive sweeps are combined in conjugate directions. Where that is
/// enough, sweeps are in single precision first, many contacts side by side. Ends at the tolerance,
/// at what is enough, or after `options.sweeps`.
///
/// @param rows        of the problem
/// @param projection  where to start from; afterwards what the last sweep left
void project_by_gauss_seidel(const ContactProblem& problem, const ContactRows& rows,
                             const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
