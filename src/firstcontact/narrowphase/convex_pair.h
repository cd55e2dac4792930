/// @file
/// First contact of two moving convex sets: certified advance along directions.

#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/convex_closest.h>

namespace firstcontact {

/// [m]  The error of gaps and distances of two convex cores at a state.
///
/// advance_convex() and convex_first_contact() need it.
///
/// Derivation, u = 2^-53, S = reach_A + reach_B + |p_AB|: the stored R is within 22 u plus the
/// rotation error of the exact one. So h(R^T n) errs by that times the reach and |n|. The product
/// R^T n adds 6 u of it, n . centre 6 u of S, and the sums 8 u. Directions of at most twice the
/// length of n are used; their own rounding and that of a chord's slope add 20 u S. The sum is
/// below 128 u S. The bound takes 256 u, so that it covers points (ConvexClosest) as well, and
/// counts errors of the motion four times.
[[nodiscard]] inline double convex_gap_error(const RelativeState& state, double reach_A,
                                             double reach_B) {
  return 0x1p-45 * (reach_A + reach_B + state.p_AB.norm()) +
         4.0 * (state.position_error + state.rotation_error_A * reach_A +
                state.rotation_error_B * reach_B);
}

/// The time for which two convex cores provably stay farther apart than `threshold`.
///
/// Claims: for every t' in [t, t + tau], t' within the piece, the exact distance of the two cores
/// is > threshold.
///
/// Derivation: a and b are points of the bodies, seen from the origin of the state's frame. u_A,
/// u_B are the axes, w_A, w_B the rates, and Q_A, Q_B the pivots. s is the velocity of Q_B relative
/// to Q_A. Let m_A = w_A n x u_A and m_B = w_B n x u_B. Along a fixed n the gap n . (b - a) changes
/// at first at the rate n . (v_b - v_a) = n . s + m_B . (b - Q_B) - m_A . (b - Q_A). Its rate
/// changes at most by K (advance.h). So after tau the gap of all points is at least
///   -h_B(-(n + tau m_B)) - h_A(n + tau m_A) + tau (n . s - m_B . Q_B + m_A . Q_A) - K tau^2 / 2,
/// with h the support functions of the placed cores. A support function is convex. So on [0, H] it
/// is at most its chord between upper bounds of its values at both ends, and the first terms are at
/// least linear in tau. The direction may also turn with A. Then h_A(n) stays, m_B - m_A takes the
/// place of m_B, and K is that of advance.h for this case. It may likewise turn with B.
///
/// A fourth certificate holds for any turn. A point of A stays on its circle about u_A, so that
///   n . (a - Q_A) <= max of (n . u_A) (u_A . (a - Q_A)) + |n x u_A| reach_across,
/// which does not change while A turns. As exact motions may depart from their models, the drift
/// adds to each rate and the bend to each K.
///
/// H is chosen by an estimate of the step, such that H |m| <= 1. Every n and every H certify; the
/// longest step is taken, or the first that holds beyond t_end.
///
/// @param A, B       placed by the state: R is R_WA and R_WB; the origin of the core's frame may be
///                   any point of the body
/// @param n          [-]  unit up to rounding, from A towards B
/// @param threshold  [m]
/// @param error      [m]  at least convex_gap_error()
/// @param t_end      no farther is of interest; at most the end of the piece
[[nodiscard]] FIRSTCONTACT_API double advance_convex(const RelativeState& state,
                                                     const PlacedConvex& A, const PlacedConvex& B,
                                                     const Eigen::Vector3d& n, double threshold,
                                                     double error, double t_end);

/// Two convex cores over one piece of a motion that was entered, in the frames of the motion's
/// points C.
struct ConvexPair {
  const ConvexCore& A;
  const ConvexCore& B;
  const PairMotion& motion;
};

struct ConvexContactOptions {
  double threshold = 0.0;  ///< [m]  Closer than this is contact; roundings of the sets are
                           ///< included.
  /// [m]  A contact is no farther than threshold + tolerance; > 0.
  double tolerance = 1e-6;
  double t_begin = 0.0;  ///< [-]  Proven: no contact before.
  double t_end = 1.0;    ///< [-]  At most the end of the piece.
  std::uint64_t most_steps = ~std::uint64_t{0};
};

enum class ConvexVerdict {
  free,        ///< Proven: farther apart than the threshold on all of [t_begin, t_end].
  contact,     ///< Proven: so before t; at t no farther than threshold + tolerance.
  unresolved,  ///< Proven so before t; doubles allow no further step.
  unfinished,  ///< Proven so before t; most_steps were taken.
};

struct ConvexContact {
  ConvexVerdict verdict = ConvexVerdict::unfinished;
  double t = 0.0;  ///< [-]  Proven: no contact in [t_begin, t); t_end when free.
  /// [m]  Bound of the distance of two points of the cores at t, its error included; where free, at
  /// the last step.
  double distance_bound = std::numeric_limits<double>::infinity();
  std::uint64_t steps = 0;
};

/// Finds the first time in [t_begin, t_end] at which two convex cores come within the threshold.
///
/// Method: conservative advancement (B. Mirtich, 1996) by advance_convex(), along the direction
/// with which the search for the closest points ends. A contact is reported where two points of the
/// cores are within threshold + tolerance / 2, their error included: an upper bound of the
/// distance. A gap along a direction certifies a step: a lower bound. Neither replaces the other.
///
/// Between neighbouring doubles of t fast bodies may pass the tolerance. That is `unresolved`, as
/// is a tolerance below the rounding.
///
/// @param guess  for the same two cores, or a direction alone; receives the end of the search
[[nodiscard]] FIRSTCONTACT_API ConvexContact convex_first_contact(
    const ConvexPair& pair, const ConvexContactOptions& options, ConvexGuess& guess);

}  // namespace firstcontact
