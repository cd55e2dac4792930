/// @file
/// The motions that the contacts at a place hold back least.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/planning/detail/mover_contact_finder.h>
#include <firstcontact/planning/detail/tangent_space.h>

namespace firstcontact::detail {

/// Finds motions that bring no contact nearer nor farther, to first order, the loosest first.
///
/// A contact i changes by J_i dq. The motions are the dq of length 1 for which the sum of (J_i
/// dq)^2 is least: its eigenvectors of small eigenvalues. So the contacts of a peg give its hole's
/// axis. Those of a nut give the screw of its thread, with the pitch.
///
/// @param at  with at least one contact
/// @returns motions of length 1 in the metric of the space; each sense is possible
[[nodiscard]] std::vector<Eigen::VectorXd> loose_motions(const TangentSpace& tangents,
                                                         const ContactsAt& at);

}  // namespace firstcontact::detail
