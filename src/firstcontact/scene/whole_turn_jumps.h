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
  std::string joint;  ///< Name in the trajectory.
  double time = 0.0;  ///< [s]  Time of the point after the first jump.
  double from = 0.0;  ///< [rad]  Angle before the jump.
  double to = 0.0;
  std::size_t count = 1;  ///< Number of jumps of this joint.
};

/// The joints whose angles wrap, in the order of the trajectory.
///
/// Such steps are of a recording, not of a motion. There are none where the trajectory takes the
/// short way anyway.
///
/// A step between neighbouring points is a jump under three conditions. It is of more than half a
/// turn, all angles of the joint lie within one turn, and it is no motion. With velocities it is no
/// motion if the short way is nearer to their integral over the step. Without velocities it is no
/// motion in two cases. In the first the step is faster than the joint's velocity limit, and the
/// short way is not. In the second the step is three times as fast as any other one, and the short
/// way is not faster than others. These are estimates: they decide nothing but a warning.
///
/// Joints wrap if they can turn by more than a whole turn: continuous, planar, and revolute ones
/// whose limits are farther apart. Joints that mimic others do not.
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

/// Describes a jump and its remedy: "joint "wrist" jumps from 3.1 to -3.1 rad at 1.2 s, and 3 times
/// more: ...".
[[nodiscard]] FIRSTCONTACT_API std::string describe(const WholeTurnJump& jump);

}  // namespace firstcontact
