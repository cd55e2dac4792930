#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/foreign_scenes/detail/pose_constraints.h>
#include <firstcontact/foreign_scenes/detail/robot_state.h>
#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/fixed_joints.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact {
namespace {

using detail::find_filled;
using detail::in_quotes;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

/// Refuses attached objects in the start state of a request.
void refuse_attached(const JsonValue& state, const JsonReader& read) {
  if (const JsonValue* attached = find_filled(state, "attached_collision_objects")) {
    read.fail(*attached, "expected no attached objects here; they belong to the planning scene");
  }
}

/// Reads the pose of the joint between the world and the root link.
detail::MessagePose read_base(const JsonValue& state, const RobotModel& robot,
                              const JsonReader& read) {
  const std::optional<detail::WorldJoint> joint = detail::read_world_joint(state, read);
  if (!joint) {
    return {};
  }
  const std::string name = detail::name_of(joint->name, "the name of a joint", read);
  if (robot.find_joint(name)) {
    read.fail(joint->name, "expected the joint between the world and the robot, got its joint " +
                               in_quotes(name));
  }
  return joint->base;
}

/// Refuses unknown keys of a request: they would be left out without notice.
void require_request_keys(const JsonValue& request, const JsonReader& read) {
  (void)read.object(
      request, {{"workspace_parameters", "start_state", "goal_constraints", "path_constraints",
                 "trajectory_constraints", "reference_trajectories", "pipeline_id", "planner_id",
                 "group_name", "num_planning_attempts", "allowed_planning_time",
                 "max_velocity_scaling_factor", "max_acceleration_scaling_factor",
                 "cartesian_speed_end_effector_link", "cartesian_speed_limited_link",
                 "max_cartesian_speed"}});
}

const JsonValue& only_goal(const JsonValue& request, const JsonReader& read) {
  const JsonValue& goals = read.member(request, "goal_constraints");
  const JsonArray& list = read.array(goals, "an array of goals");
  if (list.size() != 1) {
    read.fail(goals, "expected one goal, got " + std::to_string(list.size()));
  }
  (void)read.object(list.front(), {{"name", "joint_constraints", "position_constraints",
                                    "orientation_constraints", "visibility_constraints"}});
  return list.front();
}

/// Refuses a message of constraints that is not empty.
///
/// @param where  the constraints hold, for errors: "along the path"
void refuse_constraints(const JsonValue& constraints, const std::string& where,
                        const JsonReader& read) {
  for (const char* key : {"joint_constraints", "position_constraints", "orientation_constraints",
                          "visibility_constraints"}) {
    if (const JsonValue* some = find_filled(constraints, key)) {
      read.fail(*some, "expected no constraints " + where + ": they are not supported");
    }
  }
}

/// Refuses constraints that would not be kept here.
void refuse_other_constraints(const JsonValue& request, const JsonValue& goal,
                              const JsonReader& read) {
  if (const JsonValue* visible = find_filled(goal, "visibility_constraints")) {
    read.fail(*visible, "expected no constraints of visibility: they are not supported");
  }
  if (const JsonValue* along = find_filled(request, "path_constraints")) {
    refuse_constraints(*along, "along the path", read);
  }
  const JsonValue* trajectory = find_filled(request, "trajectory_constraints");
  const JsonValue* list = trajectory == nullptr ? nullptr : find_filled(*trajectory, "constraints");
  if (list != nullptr) {
    for (const JsonValue& constraints : read.array(*list, "an array of constraints")) {
      refuse_constraints(constraints, "of the trajectory", read);
    }
  }
}

bool is_of_link(const JsonValue& goal) {
  return find_filled(goal, "position_constraints") != nullptr ||
         find_filled(goal, "orientation_constraints") != nullptr;
}

/// Reads the positions that the joints shall reach.
detail::MessageState read_joint_goal(const JsonValue& constraints, const RobotModel& robot,
                                     const JsonReader& read) {
  detail::MessageState goal;
  for (const JsonValue& constraint : read.array(constraints, "an array of joint constraints")) {
    (void)read.object(constraint,
                      {{"joint_name", "position", "tolerance_above", "tolerance_below", "weight"}});
    detail::add_position(read.member(constraint, "joint_name"), read.member(constraint, "position"),
                         robot, read, goal);
  }
  return goal;
}

}  // namespace

PlanningRequest parse_planning_request(std::string_view text, const std::filesystem::path& source,
                                       const RobotModel& robot) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_tree(text, source);
  const JsonReader read(root, name);
  const JsonValue& request =
      detail::unwrap_message(root, {"motion_plan_request", "request"}, "goal_constraints");
  if (!std::holds_alternative<JsonObject>(request.value)) {
    read.fail_expected("a request, an object with \"start_state\" and \"goal_constraints\"",
                       request);
  }
  require_request_keys(request, read);
  PlanningRequest result;
  std::vector<std::string> fixed;
  if (const JsonValue* state = find_filled(request, "start_state")) {
    detail::require_state_keys(*state, read);
    refuse_attached(*state, read);
    if (const JsonValue* joints = find_filled(*state, "joint_state")) {
      detail::MessageState start = detail::read_joint_state(*joints, robot, read);
      result.start = std::move(start.positions);
      fixed = std::move(start.fixed);
    }
    const detail::MessagePose base = read_base(*state, robot, read);
    result.base = base.pose;
    if (base.has_zero_quaternion) {
      result.warnings.push_back(detail::zero_quaternion_warning(name, {"the robot's base"}));
    }
  }
  const JsonValue& wanted = only_goal(request, read);
  refuse_other_constraints(request, wanted, read);
  const JsonValue* constraints = find_filled(wanted, "joint_constraints");
  if ((constraints != nullptr) == is_of_link(wanted)) {
    read.fail(wanted,
              "expected \"joint_constraints\" alone, or \"position_constraints\" and "
              "\"orientation_constraints\" of one link");
  }
  if (constraints != nullptr) {
    detail::MessageState goal = read_joint_goal(*constraints, robot, read);
    result.goal = std::move(goal.positions);
    fixed.insert(fixed.end(), goal.fixed.begin(), goal.fixed.end());
  } else {
    result.link_goal = detail::read_pose_constraints(wanted, robot, result.base, read);
  }
  if (!fixed.empty()) {
    result.warnings.push_back(name + ": " + detail::fixed_joints_warning(std::move(fixed)));
  }
  return result;
}

PlanningRequest read_planning_request(const std::filesystem::path& path, const RobotModel& robot) {
  return parse_planning_request(detail::read_file(path, "a request"), path, robot);
}

Trajectory straight_motion(const RobotModel& robot, const JointPositions& start,
                           const JointPositions& goal, Turning turning) {
  Trajectory trajectory{
      .joint_names = {}, .points = {{.time = 0.0}, {.time = 0.0}}, .turning = turning};
  double duration = 0.0;
  for (const auto& [name, position] : goal) {
    const JointCoordinate coordinate = find_coordinate(robot, name);
    const Joint& joint = robot.joints()[coordinate.joint];
    if (joint.mimic) {
      continue;  // It follows another joint.
    }
    const auto found = start.find(name);
    const double from = found != start.end() ? found->second : default_position(joint);
    trajectory.joint_names.push_back(name);
    trajectory.points[0].positions.push_back(from);
    trajectory.points[1].positions.push_back(position);
    const bool is_short = turning == Turning::shortest && takes_short_way(robot, coordinate);
    const double way = is_short ? shortest_way(from, position) : position - from;
    if (joint.limits.velocity.value_or(0.0) > 0.0) {
      duration = std::max(duration, std::abs(way) / *joint.limits.velocity);
    }
  }
  // A little longer, so that rounding exceeds no limit.
  trajectory.points[1].time = duration > 0.0 ? duration * (1.0 + 0x1p-40) : 1.0;
  return trajectory;
}

}  // namespace firstcontact
