/// @file
/// Contact problems without drives, solved from inside the cones of their contacts.

#pragma once

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Solves a problem of many contacts without drives, in rounds.
///
/// In a round mu |u_t| is fixed at its value after the round before, at first that of the
/// projection. With P = diag(1, mu, mu), y = P u + mu |u_t| n and z = P^-1 r then lie in the cone
/// of Lorentz, orthogonal to each other. This problem is convex. Newton's steps with the scaling of
/// Nesterov and Todd solve it from inside. Their number depends little on the number of contacts,
/// and each takes the factorisation of one matrix (S. Mehrotra, SIAM Journal on Optimization 2
/// (1992)). Sweeps of all contacts follow. The rounds are the fixed point of V. Acary, F. Cadoux,
/// C. Lemarechal, J. Malick, "A formulation of the linear discrete Coulomb friction problem via
/// convex optimization", ZAMM 91 (2011).
///
/// The projection stays as it is where none is found that is nearer to the laws.
void project_by_interior_point(const ContactProblem& problem, const ContactRows& rows,
                               const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
