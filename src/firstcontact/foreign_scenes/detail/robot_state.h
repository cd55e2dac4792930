/// @file
/// Reads the state of a robot in MoveIt's messages: moveit_msgs/RobotState.

#pragma once

#include <vector>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact::detail {

/// A joint whose position is a pose: one of the robot, or that between the world and its root link.
struct PosedJoint {
  const JsonValue& name;
  const JsonValue& transform;
  MessagePose pose;  ///< Pose of the child in the joint's frame.
};

/// Refuses unknown keys of a state.
void require_state_keys(const JsonValue& state, const JsonReader& read);

/// Reads multi_dof_joint_state: joints and poses, as many of both.
[[nodiscard]] std::vector<PosedJoint> read_posed_joints(const JsonValue& state,
                                                        const JsonReader& read);

/// Adds the coordinates of a planar or floating joint of the robot at a pose.
///
/// MoveIt's planar joints move in the plane x, y: one with another axis is refused here.
void add_pose(const PosedJoint& posed, const Joint& joint, const JsonReader& read,
              JointPositions& positions);

}  // namespace firstcontact::detail
