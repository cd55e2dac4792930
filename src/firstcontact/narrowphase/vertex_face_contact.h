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
/// stands still. A bound K of |f''| (oscillation.h) puts f between two parabolas; where these fall
/// through 0, the root of f is isolated, and f keeps its sign back to twice as far as |f'| / K.
/// Steps along the gap from the face's nearest point lead there; near the root they are Newton's.
/// It is a contact where p is inside the face on all of the isolating interval. Exact contacts with
/// the face's border, tangential ones and slides within the plane (f = 0 throughout) cannot be
/// proven in rounded arithmetic; `existence_proven` and `degenerate` say so.
///
/// Sources: J. Canny, "Collision detection for moving polyhedra", IEEE Trans. PAMI 8 (1986), for
/// the equations; S. Redon, A. Kheddar, S. Coquillart, "Fast continuous collision detection between
/// rigid bodies", Computer Graphics Forum 21 (2002), for interval root isolation on one relative
/// motion, which the one-sided parabolas replace.
///
/// Proven for the exact motion that `motion` was made of; see ElementaryContact. Not symmetric: for
/// a vertex of A and a face of B swap the paths of the relative motion.
///
/// @param face_A    [m]  corners from the point of A that its path leads, in A's axes; may be
/// degenerate
/// @param vertex_B  [m]  likewise for B
[[nodiscard]] FIRSTCONTACT_API ElementaryContact
vertex_face_contact(const ElementaryMotion& motion, const Triangle& face_A,
                    const Eigen::Vector3d& vertex_B, const ElementaryOptions& options = {});

}  // namespace firstcontact
