/// @file
/// Reads the state of a robot in MoveIt's messages: moveit_msgs/RobotState.

#pragma once

#include <optional>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact::detail {

/// The joint between the world and the root link of a robot.
struct WorldJoint {
  const JsonValue& name;
  const JsonValue& transform;
  MessagePose base;  ///< Pose of the root link in the world.
};

/// Refuses unknown keys of a state.
void require_state_keys(const JsonValue& state, const JsonReader& read);

/// Reads multi_dof_joint_state, which may have at most one joint here.
[[nodiscard]] std::optional<WorldJoint> read_world_joint(const JsonValue& state,
                                                         const JsonReader& read);

}  // namespace firstcontact::detail
