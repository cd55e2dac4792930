/// @file
/// Reads the parts that ROS messages share, from trees of YAML or JSON.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// The message itself, where another one holds it under one of the keys.
///
/// @param own  a key of the message itself
[[nodiscard]] const JsonValue& unwrap_message(const JsonValue& root,
                                              const std::vector<std::string_view>& keys,
                                              std::string_view own);

/// The value of a key where it is there and filled: not null, no empty list.
[[nodiscard]] const JsonValue* find_filled(const JsonValue& object, std::string_view key);

/// [x, y, z] or {x: , y: , z: }.
[[nodiscard]] Eigen::Vector3d read_point(const JsonValue& value, const JsonReader& read);

/// A pose as messages have it.
struct MessagePose {
  Pose pose;
  /// Its quaternion was never set: all zeros, which MoveIt takes as the identity, and so does this.
  bool has_zero_quaternion = false;
};

/// geometry_msgs/Pose: `position` and `orientation` (x, y, z, w), each the identity by default; or
/// Transform: `translation` and `rotation`.
[[nodiscard]] MessagePose read_message_pose(const JsonValue& value, const JsonReader& read);

/// X_AC = X_AB X_BC in double precision; exact where either is the identity.
[[nodiscard]] Pose compose(const Pose& X_AB, const Pose& X_BC);

/// One warning for all poses of a file with a quaternion of zeros.
///
/// @param of  what has such a pose, each once or more; at least one
[[nodiscard]] std::string zero_quaternion_warning(const std::string& source,
                                                  const std::vector<std::string>& of);

/// Positions of a message, and the fixed joints that it names as well.
struct MessageState {
  JointPositions positions;
  std::vector<std::string> fixed;
};

/// A joint of a message, and where it is.
struct NamedPosition {
  const JsonValue& name;
  const JsonValue& position;
};

/// sensor_msgs/JointState: its `name` and `position`, which are as many; none where it names none.
/// Other keys than it has are refused.
[[nodiscard]] std::vector<NamedPosition> named_positions(const JsonValue& value,
                                                         const JsonReader& read);

/// Puts the position of a joint to the others.
///
/// @throws ParseError if the robot does not have the joint, or its position is there already
void add_position(const JsonValue& joint, const JsonValue& position, const RobotModel& robot,
                  const JsonReader& read, MessageState& state);

/// sensor_msgs/JointState of the robot, as named_positions() reads it.
[[nodiscard]] MessageState read_joint_state(const JsonValue& value, const RobotModel& robot,
                                            const JsonReader& read);

}  // namespace firstcontact::detail
