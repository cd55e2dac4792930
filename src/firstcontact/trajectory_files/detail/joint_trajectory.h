/// @file
/// Reads a trajectory from a tree of JSON or YAML.

#pragma once

#include <string>

#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
class RobotModel;
}

namespace firstcontact::detail {

/// Reads our own form, or trajectory_msgs/JointTrajectory.
///
/// The keys are `joint_names` and `points`. A point has `time` [s] or `time_from_start` (`secs`,
/// `nsecs` or `sec`, `nanosec`, or a number), `positions`, `velocities` and `accelerations`.
/// Messages that hold one such trajectory are opened: `joint_trajectory`, `trajectory`,
/// `planned_trajectory`, `goal`.
///
/// @param source  names the file in warnings
/// @throws ParseError
[[nodiscard]] Trajectory read_joint_trajectory(const JsonValue& value, const RobotModel& robot,
                                               const std::string& source, const JsonReader& read);

/// The text of a scalar: YAML makes a number of a name such as 1.
///
/// @throws ParseError if it is no scalar
[[nodiscard]] std::string name_of(const JsonValue& value, const std::string& what,
                                  const JsonReader& read);

/// Reads a position of a joint [rad or m], no larger than a CoordinatePath can have.
[[nodiscard]] double joint_position(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
