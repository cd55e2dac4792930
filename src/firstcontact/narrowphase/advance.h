/// @file
/// The certified advance of a moving pair: for how long a gap along one direction stays open.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// Two triangles at one instant of a relative motion, in the frame of the state.
struct TrianglePair {
  Triangle A;
  Triangle B;
};

/// The time for which two triangles provably stay farther apart than `threshold`.
///
/// Claims: for every t' in [t, t + tau], t' within the piece, the exact distance of the two
/// triangles is > threshold. Source: conservative advancement (B. Mirtich, 1996) with a
/// second-order bound along a direction.
///
/// Derivation: along a fixed unit n the gap of two points changes at the rate n . (v_b - v_a). The
/// size of its own rate is at most
///   K = w_A^2 |n x u_A| rho_A + w_B^2 |n x u_B| rho_B,
/// as the acceleration of a point is -w^2 rho_perp with |rho_perp| constant. Body A may also carry
/// n, which then turns with it. A's points stand still, and in A's turning frame a point b of B has
///   K = w_B^2 rho_B + 2 w_A |n x u_A| (|s| + w_B rho_B) + w_A^2 |n x u_A| D.
/// Its terms are the accelerations of B, of Coriolis and of the turning frame. s is the relative
/// velocity of the pivots, and D bounds |b - Q_A| up to t_end.
///
/// All this holds for the model motions. Exact motions may depart from these: the state's drift
/// adds to the rate, and its bend for the corners' reach adds to K. Every direction certifies. The
/// best of the three is taken, or the first that holds beyond t_end.
///
/// @param pair       positions at the state's time t
/// @param n          [-]  unit up to rounding, from A towards B
/// @param threshold  [m]
/// @param error      [m]  of the gap: positions, transforms and products
/// @param t_end      no farther is of interest; at most the end of the piece
FIRSTCONTACT_API double advance(const RelativeState& state, const TrianglePair& pair,
                                const Eigen::Vector3d& n, double threshold, double error,
                                double t_end);

}  // namespace firstcontact
