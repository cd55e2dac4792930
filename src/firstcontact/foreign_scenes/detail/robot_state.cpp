#include <firstcontact/foreign_scenes/detail/robot_state.h>

namespace firstcontact::detail {

void require_state_keys(const JsonValue& state, const JsonReader& read) {
  (void)read.object(
      state, {{"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}});
}

std::optional<WorldJoint> read_world_joint(const JsonValue& state, const JsonReader& read) {
  const JsonValue* joints = find_filled(state, "multi_dof_joint_state");
  if (joints == nullptr) {
    return std::nullopt;
  }
  (void)read.object(*joints, {{"header", "joint_names", "transforms", "twist", "wrench"}});
  if (find_filled(*joints, "joint_names") == nullptr &&
      find_filled(*joints, "transforms") == nullptr) {
    return std::nullopt;
  }
  const JsonValue& names = read.member(*joints, "joint_names");
  const JsonValue& transforms = read.member(*joints, "transforms");
  const JsonArray& list = read.array(names, "an array of joint names");
  const JsonArray& poses = read.array(transforms, "an array of transforms");
  if (list.size() != 1 || poses.size() != 1) {
    read.fail(transforms,
              "expected one joint, between the world and the robot, with one transform");
  }
  return WorldJoint{list[0], poses[0], read_message_pose(poses[0], read)};
}

}  // namespace firstcontact::detail
