/// @file
/// The elementary test of two moving edges.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact {

using Edge = std::array<Eigen::Vector3d, 2>;  ///< [m]  End points; may coincide.

/// Finds the first time at which edge ab of body A crosses edge cd of body B.
///
/// The method is that of vertex_face_contact(). The coplanarity function is
///   f(t) = (c - a) . ((b - a) x (d - c)).
/// Its two edges turn against each other. A root is a contact where the lines cross inside both
/// edges. Where the edges stay parallel or in one plane, f vanishes throughout. The gap between
/// their nearest points then decides, and a touch of such edges is `degenerate`.
///
/// Symmetric in A and B up to rounding.
///
/// @param edge_A  [m]  ends in A's axes, from the point of A that its path moves
/// @param edge_B  [m]  likewise for B
[[nodiscard]] FIRSTCONTACT_API ElementaryContact
edge_edge_contact(const ElementaryMotion& motion, const Edge& edge_A, const Edge& edge_B,
                  const ElementaryOptions& options = {});

}  // namespace firstcontact
