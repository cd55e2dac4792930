/// @file
/// What rows of ties do to each other, and which say again what others say.

#pragma once

#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

/// [1/kg]  What an impulse along one row does to the velocity along another one.
[[nodiscard]] double inverse_mass_between(const TieRow& one, const TieRow& other,
                                          const ContactProblem& problem);

/// The rows that the rows before them imply, as the second hinge of a door, and those that nothing
/// can move along.
///
/// A Cholesky factorisation of J M^-1 J^T finds them, row by row. Less than 1e-12 of such a row's
/// greatest possible response is left: rounding, or the square of how exactly joints hold.
///
/// @param problem  with the rows as its ties: joints where bodies are now
[[nodiscard]] std::vector<bool> find_redundant(const ContactProblem& problem);

/// Lets a row have no impulse.
void take_out(TieRow& row);

}  // namespace firstcontact::detail
