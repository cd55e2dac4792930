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

/// How long two triangles provably stay farther apart than `threshold`.
///
/// Claims: for every t' in [t, t + tau], t' within the piece, the exact distance of the two
/// triangles is > threshold. Source: conservative advancement (B. Mirtich, 1996) with a
/// second-order bound along a direction. Derivation: along a fixed unit n the gap of two points
/// changes at the rate n . (v_b - v_a), whose own rate is at most
///   K = w_A^2 |n x u_A| rho_A + w_B^2 |n x u_B| rho_B
/// in size, as the acceleration of a point is -w^2 rho_perp with |rho_perp| constant. Carried by
/// body A, n turns with it; A's points stand still, and in A's turning frame a point b of B has
///   K = w_B^2 rho_B + 2 w_A |n x u_A| (|s| + w_B rho_B) + w_A^2 |n x u_A| D,
/// the accelerations of B, of Coriolis and of the turning frame, with s the relative velocity of
/// the pivots and D a bound of |b - Q_A| up to t_end. That holds for the model motions; what exact
/// ones may depart from them adds the state's drift to the rate and its bend for the corners' reach
/// to K. Every direction certifies; the best of the three is taken, or the first that holds beyond
/// t_end.
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
