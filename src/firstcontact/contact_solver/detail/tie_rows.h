/// @file
/// Couplings of rows of ties, and the rows that others imply.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

/// [1/kg]  Computes the velocity along one row that a unit impulse along another row causes.
[[nodiscard]] double inverse_mass_between(const TieRow& one, const TieRow& other,
                                          const ContactProblem& problem);

/// Finds the rows that the rows before them imply, as the second hinge of a door, and those along
/// which nothing can move.
///
/// A Cholesky factorisation of J M^-1 J^T finds them, row by row. Less than 1e-12 of such a row's
/// greatest possible response is left. That is rounding, or the square of the precision to which
/// joints hold.
///
/// @param problem  with the rows as its ties: joints where bodies are now
[[nodiscard]] std::vector<bool> find_redundant(const ContactProblem& problem);

/// Finds them likewise, and which rows from the first one on have less than a part of their own
/// response left across the rows before.
///
/// @param least  [-]  that part
[[nodiscard]] std::vector<bool> find_redundant(const ContactProblem& problem, std::size_t first,
                                               double least);

/// Lets a row have no impulse.
void take_out(TieRow& row);

}  // namespace firstcontact::detail
