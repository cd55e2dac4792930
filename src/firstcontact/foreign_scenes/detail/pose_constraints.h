/// @file
/// Goals of a moveit_msgs/MotionPlanRequest that are poses of a link.

#pragma once

#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads `position_constraints` and `orientation_constraints` of a goal: one of the first, and at
/// most one of the second for the same link.
///
/// The region of the position is a sphere, a box or a cylinder. The goal is the ball in it around
/// its middle. A constraint has three tolerances about axes. Half of the least one bounds the
/// rotation, for every parameterization that the message may name.
///
/// @param X_WR  of the root link, whose name is a frame, too
/// @throws ParseError
[[nodiscard]] LinkGoal read_pose_constraints(const JsonValue& goal, const RobotModel& robot,
                                             const Pose& X_WR, const JsonReader& read);

}  // namespace firstcontact::detail
