/// @file
/// The elementary test of a moving vertex and a moving face.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/narrowphase/elementary_contact.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// Finds the first time at which vertex p of body B lies on a face abc of body A.
///
/// The coplanarity function f(t) = (p - a) . ((b - a) x (c - a)) is seen from A, where the face
/// stands still. A bound K of |f''| (oscillation.h) puts f between two parabolas. Where these fall
/// through 0, the root of f is isolated, and f keeps its sign back to twice as far as |f'| / K.
/// Steps along the gap from the face's nearest point lead there. Near the root they are Newton's
/// steps.
///
/// A root is a contact where p is inside the face on all of the isolating interval. Rounded
/// arithmetic cannot prove exact contacts with the face's border, tangential contacts and slides
/// Sources: the equations are from J. Canny, "Collision detection for moving polyhedra", IEEE
/// Trans. PAMI 8 (1986). Interval root isolation on one relative motion is from S. Redon, A.
/// Kheddar, S. Coquillart, "Fast continuous collision detection between rigid bodies", Computer
/// Graphics Forum 21 (2002). The one-sided parabolas replace it here.
/// Graphics Forum 21 (2002). The one-sided parabolas replace it here.
///
/// Proven for the exact motion that `motion` was made of; see ElementaryContact. Not symmetric: for
/// a vertex of A and a face of B swap the paths of the relative motion.
///
/// @param face_A    [m]  corners in A's axes, from the point of A that its path moves; may be
///                  degenerate
/// @param vertex_B  [m]  likewise for B
[[nodiscard]] FIRSTCONTACT_API ElementaryContact
vertex_face_contact(const ElementaryMotion& motion, const Triangle& face_A,
                    const Eigen::Vector3d& vertex_B, const ElementaryOptions& options = {});

}  // namespace firstcontact
