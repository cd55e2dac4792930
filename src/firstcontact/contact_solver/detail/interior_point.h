/// @file
/// Contact problems without drives from inside the cones of their contacts.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// For many contacts and no drives. In rounds: mu |u_t| is taken to be what it was after the round
/// before, at first that of the projection. With P = diag(1, mu, mu) it is then y = P u + mu |u_t|
/// n and z = P^-1 r that lie in the cone of Lorentz, orthogonal to each other, a convex problem;
/// Newton's steps with the scaling of Nesterov and Todd solve it from inside, in about as many
/// steps for each number of contacts, each the factorisation of one matrix (S. Mehrotra, SIAM
/// Journal on Optimization 2 (1992)). Sweeps of all contacts follow. That is the fixed point of V.
/// Acary, F. Cadoux, C. Lemarechal, J. Malick, "A formulation of the linear discrete Coulomb
/// friction problem via convex optimization", ZAMM 91 (2011).
///
/// Leaves the projection as it is where it finds none that is nearer to the laws.
void project_by_interior_point(const ContactProblem& problem, const ContactRows& rows,
                               const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
