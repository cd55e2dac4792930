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

/// Our own form, or trajectory_msgs/JointTrajectory: `joint_names`, `points`, of each point `time`
/// [s] or `time_from_start` (`secs`, `nsecs` or `sec`, `nanosec`, or a number), `positions`,
/// `velocities`, `accelerations`. Messages that hold one such trajectory are opened:
/// `joint_trajectory`, `trajectory`, `planned_trajectory`, `goal`.
///
/// @param source  names the file in warnings
/// @throws ParseError
[[nodiscard]] Trajectory read_joint_trajectory(const JsonValue& value, const RobotModel& robot,
                                               const std::string& source, const JsonReader& read);

/// The word that a scalar is: YAML makes a number of a name such as 1.
///
/// @throws ParseError if it is none
[[nodiscard]] std::string name_of(const JsonValue& value, const std::string& what,
                                  const JsonReader& read);

/// One position of a joint [rad or m], no larger than a CoordinatePath can be.
[[nodiscard]] double joint_position(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
