#include <firstcontact/foreign_scenes/detail/pose_constraints.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact::detail {
namespace {

constexpr double kAnyTurn = 4.0;        // [rad]  More than half a turn.
constexpr double kLeast = 1e-6;         // [m or rad]  Taken where a tolerance is 0.
constexpr std::size_t kPrimitives = 4;  // 1 box, 2 sphere, 3 cylinder, 4 cone.

/// Finds the frame of a constraint in the world: that of planning, or of the root link.
Pose frame_of(const JsonValue& constraint, const RobotModel& robot, const Pose& X_WR,
              const JsonReader& read) {
  const JsonValue* header = find_filled(constraint, "header");
  if (header != nullptr) {
    (void)read.object(*header, {{"seq", "stamp", "frame_id"}});
  }
  const JsonValue* frame = header == nullptr ? nullptr : find_filled(*header, "frame_id");
  const std::string name = frame == nullptr ? "" : read.string(*frame, "the name of a frame");
  if (name.empty() || name == "world") {
    return {};
  }
  const std::string& root = robot.links()[robot.root()].name;
  if (name != root) {
    read.fail(*frame, "expected the frame \"world\" or that of the root link " + in_quotes(root) +
                          ", got " + in_quotes(name));
  }
  return X_WR;
}

const JsonValue& only_one(const JsonValue& goal, std::string_view key, const JsonReader& read) {
  const JsonValue& all = read.member(goal, key);
  const JsonArray& list = read.array(all, "an array with one constraint");
  if (list.size() != 1) {
    read.fail(all, "expected one constraint, got " + std::to_string(list.size()));
  }
  return list.front();
}

std::string link_of(const JsonValue& constraint, const RobotModel& robot, const JsonReader& read) {
  const JsonValue& link = read.member(constraint, "link_name");
  const std::string name = read.string(link, "the name of a link");
  if (!robot.find_link(name)) {
    read.fail(link, "expected a link of the robot, got " + in_quotes(name));
  }
  return name;
}

/// [m]  Computes the radius of the greatest ball about the middle of a primitive.
double inner_radius(const JsonValue& primitive, const JsonReader& read) {
  const JsonValue& type = read.member(primitive, "type");
  const std::size_t kind = read.index(type, kPrimitives, "1, 2 or 3: a box, a sphere, a cylinder");
  std::vector<double> sizes;
  const JsonValue& dimensions = read.member(primitive, "dimensions");
  for (const JsonValue& size : read.array(dimensions, "an array of sizes")) {
    sizes.push_back(read.not_negative(size));
  }
  const std::size_t wanted = kind == 1 ? 3 : kind == 2 ? 1 : kind == 3 ? 2 : 0;
  if (wanted == 0 || sizes.size() < wanted) {
    read.fail(primitive,
              "expected a box with three sizes, a sphere with one or a cylinder with two");
  }
  switch (kind) {
    case 1:
      return 0.5 * *std::min_element(sizes.begin(), sizes.begin() + 3);
    case 2:
      return sizes[0];
    default:
      return std::min(0.5 * sizes[0], sizes[1]);  // Height, radius.
  }
}

void take_position(const JsonValue& constraint, const RobotModel& robot, const Pose& X_WR,
                   const JsonReader& read, LinkGoal& goal) {
  (void)read.object(
      constraint, {{"header", "link_name", "target_point_offset", "constraint_region", "weight"}});
  goal.link = link_of(constraint, robot, read);
  if (const JsonValue* offset = find_filled(constraint, "target_point_offset")) {
    JsonObject pose{{"position", *offset}};
    goal.X_LT.position = read_message_pose({.value = std::move(pose)}, read).pose.position;
  }
  const JsonValue& region = read.member(constraint, "constraint_region");
  (void)read.object(region, {{"primitives", "primitive_poses", "meshes", "mesh_poses"}});
  if (const JsonValue* meshes = find_filled(region, "meshes")) {
    read.fail(*meshes, "expected a region of one primitive, got a mesh");
  }
  const JsonValue& primitive = only_one(region, "primitives", read);
  const JsonValue& pose = only_one(region, "primitive_poses", read);
  goal.position_tolerance = std::max(inner_radius(primitive, read), kLeast);
  const Pose X_WF = frame_of(constraint, robot, X_WR, read);
  goal.X_WT.position = X_WF.position + X_WF.rotation * read_message_pose(pose, read).pose.position;
}

void take_orientation(const JsonValue& constraint, const RobotModel& robot, const Pose& X_WR,
                      const JsonReader& read, LinkGoal& goal) {
  (void)read.object(constraint, {{"header", "orientation", "link_name", "absolute_x_axis_tolerance",
                                  "absolute_y_axis_tolerance", "absolute_z_axis_tolerance",
                                  "parameterization", "weight"}});
  const JsonValue& link = read.member(constraint, "link_name");
  if (link_of(constraint, robot, read) != goal.link) {
    read.fail(link, "expected the link of the position, " + in_quotes(goal.link));
  }
  const JsonValue& orientation = read.member(constraint, "orientation");
  const MessagePose turned =
      read_message_pose({.value = JsonObject{{"orientation", orientation}}}, read);
  if (turned.has_zero_quaternion) {
    read.fail(orientation, "expected a quaternion x, y, z, w of length 1, got zeros");
  }
  goal.X_WT.rotation =
      (frame_of(constraint, robot, X_WR, read).rotation * turned.pose.rotation).normalized();
  double least = 2.0 * kAnyTurn;  // Half of it is the tolerance.
  for (const char* key :
       {"absolute_x_axis_tolerance", "absolute_y_axis_tolerance", "absolute_z_axis_tolerance"}) {
    const JsonValue* tolerance = find_filled(constraint, key);
    least = std::min(least, tolerance == nullptr ? 0.0 : read.not_negative(*tolerance));
  }
  goal.rotation_tolerance = std::max(0.5 * least, kLeast);
}

}  // namespace

LinkGoal read_pose_constraints(const JsonValue& goal, const RobotModel& robot, const Pose& X_WR,
                               const JsonReader& read) {
  if (find_filled(goal, "position_constraints") == nullptr) {
    read.fail(goal,
              "expected a position beside the orientation, got \"orientation_constraints\" alone");
  }
  LinkGoal result;
  take_position(only_one(goal, "position_constraints", read), robot, X_WR, read, result);
  if (find_filled(goal, "orientation_constraints") != nullptr) {
    take_orientation(only_one(goal, "orientation_constraints", read), robot, X_WR, read, result);
  } else {
    result.rotation_tolerance = kAnyTurn;
  }
  return result;
}

}  // namespace firstcontact::detail
