/// @file
/// Reads the elements that ROS messages share, from trees of YAML or JSON.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// The message itself, also where another message holds it under one of the keys.
///
/// @param own  a key of the message itself
[[nodiscard]] const JsonValue& unwrap_message(const JsonValue& root,
                                              const std::vector<std::string_view>& keys,
                                              std::string_view own);

/// The value of a key where it has contents: not null, no empty list.
[[nodiscard]] const JsonValue* find_filled(const JsonValue& object, std::string_view key);

/// Reads [x, y, z] or {x: , y: , z: }.
[[nodiscard]] Eigen::Vector3d read_point(const JsonValue& value, const JsonReader& read);

/// A pose from a message.
struct MessagePose {
  Pose pose;
  /// Whether its quaternion is all zeros, as nothing set it. MoveIt and this reader take the
  /// identity.
  bool has_zero_quaternion = false;
};

/// Reads geometry_msgs/Pose or Transform; parts left out are the identity.
///
/// A Pose has `position` and `orientation` (x, y, z, w), a Transform `translation` and `rotation`.
[[nodiscard]] MessagePose read_message_pose(const JsonValue& value, const JsonReader& read);

/// Whether a pose moves nothing, exactly.
[[nodiscard]] bool is_identity(const Pose& pose);

/// Composes X_AC = X_AB X_BC in double precision; exact where either is the identity.
[[nodiscard]] Pose compose(const Pose& X_AB, const Pose& X_BC);

/// The warning about all poses of a file with a quaternion of zeros.
///
/// @param of  names of things with such a pose, each once or more; at least one
[[nodiscard]] std::string zero_quaternion_warning(const std::string& source,
                                                  const std::vector<std::string>& of);

/// Positions of a message, and the fixed joints that it names, too.
struct MessageState {
  JointPositions positions;
  std::vector<std::string> fixed;
};

/// A joint of a message, and its position.
struct NamedPosition {
  const JsonValue& name;
  const JsonValue& position;
};

/// Reads sensor_msgs/JointState: its `name` and `position`, which have equal lengths.
///
/// The result is empty where it names no joint. Other keys than those of the message are refused.
[[nodiscard]] std::vector<NamedPosition> named_positions(const JsonValue& value,
                                                         const JsonReader& read);

/// Adds the position of a joint to the others.
///
/// @throws ParseError if the robot does not have the joint, or its position is there already
void add_position(const JsonValue& joint, const JsonValue& position, const RobotModel& robot,
                  const JsonReader& read, MessageState& state);

/// Reads sensor_msgs/JointState of the robot, as named_positions() does.
[[nodiscard]] MessageState read_joint_state(const JsonValue& value, const RobotModel& robot,
                                            const JsonReader& read);

}  // namespace firstcontact::detail
