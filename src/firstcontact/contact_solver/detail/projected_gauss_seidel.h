/// @file
/// Contact problems in the space of impulses: sweeps over contacts, one after another.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Solves each drive and contact in turn for the impulse that meets its own laws, there and back
/// (projected Gauss-Seidel).
///
/// Successive sweeps are combined in conjugate directions. Where single precision resolves the
/// tolerance, sweeps are in single precision first, many contacts side by side. The sweeps end at
/// the tolerance, at a residual that `enough` permits, or after `options.sweeps`.
///
/// @param rows        of the problem
/// @param projection  the start; afterwards the state after the last sweep
void project_by_gauss_seidel(const ContactProblem& problem, const ContactRows& rows,
                             const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
