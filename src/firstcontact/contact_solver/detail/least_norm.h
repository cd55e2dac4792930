/// @file
/// The choice among impulses that all satisfy the laws.

#pragma once

#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Shares the impulses of few contacts evenly, where the laws leave a choice.
///
/// Four legs of a table are statically indeterminate: sweeps would share the load by the order of
/// the contacts. Here it is the solution of least norm: unique, so a symmetric problem has a
/// symmetric answer. Contacts that stick share friction in proportion to their normal impulses
/// where least norm alone would leave the cone. Contacts that slide keep their laws, but the
/// velocities may change: the torque of their friction depends on the shares.
///
/// The projection stays as it is where the laws leave no choice, where contacts are many, or where
/// no such answer is found.
///
/// @param tolerance   [m/s]  greatest residual of the answer
/// @param projection  within the tolerance, before and afterwards
void share_evenly(const ContactRows& rows, double tolerance, Projection& projection);

}  // namespace firstcontact::detail
