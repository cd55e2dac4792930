#include <firstcontact/foreign_scenes/detail/robot_state.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// The coordinates x, y and theta of a pose in the plane x, y.
std::array<double, 3> planar_positions(const PosedJoint& posed, const Joint& joint,
                                       const JsonReader& read) {
  constexpr double kFlat = 1e-6;  // [m], [-]
  const Eigen::Vector3d& p = posed.pose.pose.position;
  const Eigen::Quaterniond r = posed.pose.pose.rotation.normalized();
  if (!joint.axis.cross(Eigen::Vector3d::UnitZ()).isZero(0.0) || joint.axis.z() < 0.0) {
    read.fail(posed.name,
              "expected a planar joint about z, as MoveIt has them; give the positions of " +
                  in_quotes(joint.name) + " in the joint_state");
  }
  if (!(std::abs(p.z()) <= kFlat && std::hypot(r.x(), r.y()) <= kFlat)) {
    read.fail(posed.transform,
              "expected a pose in the plane x, y of planar joint " + in_quotes(joint.name));
  }
  return {p.x(), p.y(), 2.0 * std::atan2(r.w() < 0.0 ? -r.z() : r.z(), std::abs(r.w()))};
}

}  // namespace

void require_state_keys(const JsonValue& state, const JsonReader& read) {
  (void)read.object(
      state, {{"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}});
}

std::vector<PosedJoint> read_posed_joints(const JsonValue& state, const JsonReader& read) {
  const JsonValue* joints = find_filled(state, "multi_dof_joint_state");
  if (joints == nullptr) {
    return {};
  }
  (void)read.object(*joints, {{"header", "joint_names", "transforms", "twist", "wrench"}});
  if (find_filled(*joints, "joint_names") == nullptr &&
      find_filled(*joints, "transforms") == nullptr) {
    return {};
  }
  const JsonArray& names =
      read.array(read.member(*joints, "joint_names"), "an array of joint names");
  const JsonValue& transforms = read.member(*joints, "transforms");
  const JsonArray& poses = read.array(transforms, "an array of transforms");
  if (names.size() != poses.size()) {
    read.fail(transforms, "expected a transform for each of the " + std::to_string(names.size()) +
                              " names, got " + std::to_string(poses.size()));
  }
  std::vector<PosedJoint> result;
  for (std::size_t k = 0; k < names.size(); ++k) {
    result.push_back({names[k], poses[k], read_message_pose(poses[k], read)});
  }
  return result;
}

void add_pose(const PosedJoint& posed, const Joint& joint, const JsonReader& read,
              JointPositions& positions) {
  std::array<double, 7> numbers{};
  if (joint.type == JointType::floating) {
    const Pose& pose = posed.pose.pose;
    numbers = positions_of_pose({pose.position, pose.rotation.normalized()});
  } else if (joint.type == JointType::planar) {
    std::ranges::copy(planar_positions(posed, joint, read), numbers.begin());
  } else {
    read.fail(
        posed.name,
        "expected a planar or floating joint, or the joint between the world and the robot, got " +
            in_quotes(joint.name) + ", which is " + to_string(joint.type));
  }
  for (std::size_t k = 0; k < position_count(joint.type); ++k) {
    if (!positions.insert({coordinate_name(joint, k), numbers.at(k)}).second) {
      read.fail(posed.name, "expected each joint once, got " + in_quotes(joint.name) + " again");
    }
  }
}

}  // namespace firstcontact::detail
