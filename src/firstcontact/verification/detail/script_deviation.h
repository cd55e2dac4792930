/// @file
/// The distance of a recorded piece from the motion that the scene gives a body.

#pragma once

#include <vector>

#include <firstcontact/verification/detail/piece_motion.h>
#include <firstcontact/verification/detail/rigid_motion.h>

namespace firstcontact::detail {

/// [m]  Bounds of the distance of any point of a body from its place in a script.
struct ScriptDeviation {
  double within = 0.0;  ///< At any time of a piece.
  double at_end = 0.0;  ///< At the end of the piece.
};

/// Bounds the distance of a piece from a script.
///
/// Between two times both move at constant rates. The distance of the pivots has a second
/// derivative of at most the sum of rate^2 lever of both. The distance of the rotations changes no
/// faster than by the difference of the spins. The rounding of times is not charged.
///
/// @param begin     [s]  begin of the step of the piece
/// @param script    result of script_of(): one motion after another from 0, where 1 is the duration
/// @param duration  [s]
/// @param reach     [m]  bound of the distance of points from the pivot
[[nodiscard]] ScriptDeviation script_deviation(const PieceMotion& piece, double begin,
                                               const std::vector<RigidMotion>& script,
                                               double duration, double reach);

/// The motion of a body over a scene, and its rest after it.
///
/// @param p_BC  [m]
/// @throws UncertainMotion
[[nodiscard]] std::vector<RigidMotion> script_of(const BodyMotion& motion, double duration,
                                                 const Eigen::Vector3d& p_BC);

}  // namespace firstcontact::detail
