/// @file
/// Rows of joints that say again what others say.

#pragma once

#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

struct IslandState;

/// Whether joints of an island may say anything twice: those of a loop, of a robot or of a body
/// with locked axes. Others are a tree of bodies that move freely.
[[nodiscard]] bool may_be_redundant(const IslandState& state);

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
