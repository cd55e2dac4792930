/// @file
/// Reads the parts that ROS messages share, from trees of YAML or JSON.

#pragma once

#include <string_view>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// The value of a key where there is one that says something: not null, no empty list.
[[nodiscard]] const JsonValue* find_filled(const JsonValue& object, std::string_view key);

/// [x, y, z] or {x: , y: , z: }.
[[nodiscard]] Eigen::Vector3d read_point(const JsonValue& value, const JsonReader& read);

/// geometry_msgs/Pose: `position` and `orientation` (x, y, z, w), each the identity by default; or
/// Transform: `translation` and `rotation`.
[[nodiscard]] Pose read_message_pose(const JsonValue& value, const JsonReader& read);

/// X_AC = X_AB X_BC in double precision; exact where either is the identity.
[[nodiscard]] Pose compose(const Pose& X_AB, const Pose& X_BC);

/// sensor_msgs/JointState: `name` and `position`.
[[nodiscard]] JointPositions read_joint_state(const JsonValue& value, const RobotModel& robot,
                                              const JsonReader& read);

}  // namespace firstcontact::detail
