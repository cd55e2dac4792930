/// @file
/// Recorded trajectories whose angles wrap: from +pi to -pi from one sample to the next.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact {

/// A joint whose recorded angle jumps by whole turns.
struct WholeTurnJump {
  std::string joint;  ///< As the trajectory names it.
  double time = 0.0;  ///< [s]  Of the point after the first jump.
  double from = 0.0;  ///< [rad]  Before and after it.
  double to = 0.0;
  std::size_t count = 1;  ///< Jumps of this joint.
};

/// The joints whose angles wrap, in the order of the trajectory: what moves so is a recording, not
/// a motion. None where the trajectory takes the short way anyway.
///
/// A step between neighbouring points is a jump if it is of more than half a turn, all angles of
/// the joint lie within one turn, and it is no motion. With velocities: the short way is nearer to
/// their integral over the step. Without: the step is faster than the joint's velocity limit, the
/// short way is not; or the step is three times as fast as any other one, and the short way is not
/// faster than others. Estimates: they decide nothing but a warning.
///
/// Joints that can turn by more than a whole turn wrap: continuous, planar, and revolute ones whose
/// limits are farther apart; not those that mimic others.
///
/// @throws std::invalid_argument if the robot does not have a joint
[[nodiscard]] FIRSTCONTACT_API std::vector<WholeTurnJump> whole_turn_jumps(
    const RobotModel& robot, const Trajectory& trajectory);

/// Adds whole turns to angles of a trajectory, so that no step between points exceeds half a turn.
///
/// The sums are rounded to doubles. The angles are those of the joints that wrap, and of joints
/// that turn and mimic others.
///
/// @throws std::invalid_argument if the robot does not have a joint
[[nodiscard]] FIRSTCONTACT_API Trajectory unwrapped(const RobotModel& robot, Trajectory trajectory);

/// "joint "wrist" jumps from 3.1 to -3.1 rad at 1.2 s, and 3 times more: ...": what to do about it.
[[nodiscard]] FIRSTCONTACT_API std::string describe(const WholeTurnJump& jump);

}  // namespace firstcontact
