/// @file
/// The certified advance of a moving pair of which one triangle, or both, deform.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// The time for which two deforming triangles provably stay farther apart than `threshold`.
///
/// Their corners also move on lines of their own in their bodies' frames.
///
/// Claims: for every t' in [t, t + tau], t' within the piece, the exact distance of the two
/// triangles is > threshold.
///
/// Derivation: a corner at rho from its body's axis u, of velocity d as seen from its body, has the
/// acceleration -w^2 rho_perp + 2 w u x d. So along any n
///   |n . acceleration| <= w |n x u| (w |rho| + 2 |d|),  |rho| <= |rho(t)| + |d| (t' - t).
/// The direction may turn: n(tau) = n + tau n'. The triangles are apart where
///   n(tau) . (b - a)(tau) > threshold |n(tau)|,  |n(tau)| <= 1 + tau n . n' + tau^2 |n'|^2 / 2,
/// for each corner a of A and b of B. With b - a = e + tau e' + r the left side is exactly
///   n . e + tau (n . e' + n' . e) + tau^2 n' . e' + n(tau) . r.
/// The accelerations, and the state's drift and bend, bound r.
///
/// Every n' is valid; two are tried. n' = 0 has the least terms of second order. The other n' keeps
/// n across the edges of the closest features. Then the gaps of all their corners begin at the same
/// rate. So a corner that slides along a turning face loses only terms of second order, as in the
/// frame of a rigid face.
///
/// @param state    the motion of a body that deforms is its model: drift and bend are the other's
/// @param pair     positions at the state's time t
/// @param rates    [m per step]  velocities of the corners as seen from their bodies, in world axes
/// @param closest  the closest features of the pair; they choose n', and have no part in the claim
/// @param n        [-]  unit up to rounding, from A towards B
/// @param threshold, error, t_end  as in advance()
FIRSTCONTACT_API double advance_deforming(const RelativeState& state, const TrianglePair& pair,
                                          const TrianglePair& rates, const ClosestFeatures& closest,
                                          const Eigen::Vector3d& n, double threshold, double error,
                                          double t_end);

}  // namespace firstcontact
