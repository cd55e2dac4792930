/// @file
/// Contact problems in the space of velocities: multipliers and Newton steps.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Minimises the kinetic distance from the free velocities with an augmented Lagrangian.
///
/// It runs rounds of multipliers, each solved by Newton's steps on sparse factorisations. As in the
/// interior point, mu |u_t| is fixed at its value after the round before. Where that converges
/// slowly and bodies are few, sliding speeds are unknowns, too. Great ratios of masses cost no
/// speed. Contacts that contradict each other end it early.
///
/// @param rows        of the problem
/// @param projection  the start; afterwards nearer to the laws, if it changed
void project_by_augmented_lagrangian(const ContactProblem& problem, const ContactRows& rows,
                                     const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
