#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/foreign_scenes/detail/pose_constraints.h>
#include <firstcontact/foreign_scenes/detail/robot_state.h>
#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/text/brief_list.h>
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

/// Reads the poses of joints: those of the robot, and of the one between the world and its root
/// link, which is the base.
///
/// @returns  the names of joints whose quaternion is all zeros
std::vector<std::string> read_posed_joints(const JsonValue& state, const RobotModel& robot,
                                           const JsonReader& read, PlanningRequest& request) {
  std::vector<std::string> zero;
  std::optional<std::string> world;
  for (const detail::PosedJoint& posed : detail::read_posed_joints(state, read)) {
    const std::string name = detail::name_of(posed.name, "the name of a joint", read);
    const std::optional<std::size_t> joint = robot.find_joint(name);
    if (joint) {
      detail::add_pose(posed, robot.joints()[*joint], read, request.start);
    } else if (world) {
      read.fail(posed.name,
                "expected joints of the robot, and one between the world and the robot, got " +
                    in_quotes(*world) + " and " + in_quotes(name));
    } else {
      world = name;
      request.base = posed.pose.pose;
    }
    if (posed.pose.has_zero_quaternion) {
      zero.push_back(joint ? "joint " + name : "the robot's base");
    }
  }
  return zero;
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

/// The goals of a request, at least one. Any of them will do.
const JsonArray& goals_of(const JsonValue& request, const JsonReader& read) {
  const JsonValue& goals = read.member(request, "goal_constraints");
  const JsonArray& list = read.array(goals, "an array of goals");
  if (list.empty()) {
    read.fail(goals, "expected a goal, got none");
  }
  for (const JsonValue& goal : list) {
    (void)read.object(goal, {{"name", "joint_constraints", "position_constraints",
                              "orientation_constraints", "visibility_constraints"}});
  }
  return list;
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

/// Refuses constraints along the way, which would not be kept here.
void refuse_other_constraints(const JsonValue& request, const JsonReader& read) {
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

/// The group whose joints move: MoveIt plans for one. The SRDF tells its joints.
class MovedGroup {
 public:
  MovedGroup(const JsonValue& request, const RobotModel& robot,
             const std::vector<RobotGroup>& groups, const JsonReader& read)
      : named_(find_filled(request, "group_name")), robot_(robot), read_(read) {
    const auto* text = named_ == nullptr ? nullptr : std::get_if<std::string>(&named_->value);
    if (text != nullptr && text->empty()) {
      named_ = nullptr;
    }
    if (named_ == nullptr || groups.empty()) {
      return;
    }
    const std::string& name = read.string(*named_, "the name of a group, a string");
    const auto found = std::ranges::find(groups, name, &RobotGroup::name);
    if (found == groups.end()) {
      std::vector<std::string> names;
      std::ranges::transform(groups, std::back_inserter(names), &RobotGroup::name);
      read.fail(*named_, "expected a group of the SRDF (" + detail::some_of(names) + "), got " +
                             in_quotes(name));
    }
    group_ = &*found;
  }

  /// Refuses a goal for a joint that is not of the group.
  void require(const JsonValue& where, const std::string& name) const {
    if (group_ != nullptr && !names_fixed_joint(robot_, name) &&
        !has(find_coordinate(robot_, name).joint)) {
      read_.fail(where, "expected a joint of group " + in_quotes(group_->name) + ", got " +
                            in_quotes(name));
    }
  }

  /// The coordinates of the group, those of its followers' leaders in their place; empty where the
  /// SRDF has no groups.
  [[nodiscard]] std::vector<std::string> coordinates() const {
    std::vector<std::string> names;
    for (std::size_t joint = 0; group_ != nullptr && joint < robot_.joints().size(); ++joint) {
      if (has(joint)) {
        add_coordinates(joint, names);
      }
    }
    return names;
  }

  /// The coordinates of the group that move a link; empty where the request names no group.
  [[nodiscard]] std::vector<std::string> coordinates_above(const std::string& link) const {
    if (named_ == nullptr) {
      return {};
    }
    if (group_ == nullptr) {
      read_.fail(*named_, "expected an SRDF with groups, which tells what joints move; got none");
    }
    std::vector<std::string> names;
    for (const std::size_t joint : robot_.chain(robot_.root(), robot_.find_link(link).value())) {
      add_coordinates(joint, names);
    }
    if (names.empty()) {
      read_.fail(*named_, "expected a group that moves link " + in_quotes(link) + ", got " +
                              in_quotes(group_->name));
    }
    return names;
  }

 private:
  [[nodiscard]] bool has(std::size_t joint) const {
    return std::ranges::find(group_->joints, joint) != group_->joints.end();
  }

  /// Adds the coordinates of a joint, or of the one that it mimics, each once.
  void add_coordinates(std::size_t joint, std::vector<std::string>& names) const {
    bool is_moved = has(joint);
    while (const std::optional<Mimic>& mimic = robot_.joints()[joint].mimic) {
      joint = robot_.find_joint(mimic->joint).value();
      is_moved = is_moved || has(joint);
    }
    const JointType type = robot_.joints()[joint].type;
    const bool is_floating = type == JointType::floating;  // It is planned by its own name.
    const std::size_t count = !is_moved ? 0 : is_floating ? 1 : coordinate_count(type);
    for (std::size_t index = 0; index < count; ++index) {
      const std::string name =
          is_floating ? robot_.joints()[joint].name : coordinate_name(robot_, {joint, index});
      if (std::ranges::find(names, name) == names.end()) {
        names.push_back(name);
      }
    }
  }

  const JsonValue* named_;  // Null where the request names no group.
  const RobotModel& robot_;
  const JsonReader& read_;
  const RobotGroup* group_ = nullptr;  // Null also where the robot has no groups.
};

/// Reads a factor that a request multiplies limits by; 0, as messages have it unset, stands for 1.
double read_scaling(const JsonValue& request, const char* key, const JsonReader& read) {
  const JsonValue* value = find(std::get<JsonObject>(request.value), key);
  if (value == nullptr) {
    return 1.0;
  }
  const double factor = read.number(*value);
  if (!(factor >= 0.0 && factor <= 1.0)) {
    read.fail_expected("a factor from 0 to 1", *value);
  }
  return factor > 0.0 ? factor : 1.0;
}

/// Reads the time that a planner may take; 0, as messages have it unset, stands for none.
std::optional<double> read_planning_time(const JsonValue& request, const JsonReader& read) {
  const JsonValue* value = find(std::get<JsonObject>(request.value), "allowed_planning_time");
  if (value == nullptr) {
    return std::nullopt;
  }
  const double time = read.number(*value);
  if (!(time >= 0.0)) {
    read.fail_expected("a number > 0, or 0 for the default", *value);
  }
  return time > 0.0 ? std::optional(time) : std::nullopt;
}

/// Reads the positions that the joints shall reach.
detail::MessageState read_joint_goal(const JsonValue& constraints, const RobotModel& robot,
                                     const MovedGroup& group, const JsonReader& read) {
  detail::MessageState goal;
  for (const JsonValue& constraint : read.array(constraints, "an array of joint constraints")) {
    (void)read.object(constraint,
                      {{"joint_name", "position", "tolerance_above", "tolerance_below", "weight"}});
    const JsonValue& name = read.member(constraint, "joint_name");
    detail::add_position(name, read.member(constraint, "position"), robot, read, goal);
    group.require(name, read.string(name, "the name of a joint"));
  }
  return goal;
}

/// Reads one goal; adds the coordinates that it moves to the request, and the fixed joints that it
/// names.
RequestGoal read_goal(const JsonValue& wanted, const RobotModel& robot, const MovedGroup& group,
                      const JsonReader& read, PlanningRequest& request,
                      std::vector<std::string>& fixed) {
  if (const JsonValue* visible = find_filled(wanted, "visibility_constraints")) {
    read.fail(*visible, "expected no constraints of visibility: they are not supported");
  }
  const JsonValue* constraints = find_filled(wanted, "joint_constraints");
  if ((constraints != nullptr) == is_of_link(wanted)) {
    read.fail(wanted,
              "expected \"joint_constraints\" alone, or \"position_constraints\" and "
              "\"orientation_constraints\" of one link");
  }
  RequestGoal goal;
  std::vector<std::string> moved;
  if (constraints != nullptr) {
    detail::MessageState state = read_joint_goal(*constraints, robot, group, read);
    goal.positions = std::move(state.positions);
    moved = group.coordinates();
    fixed.insert(fixed.end(), state.fixed.begin(), state.fixed.end());
  } else {
    goal.link = detail::read_pose_constraints(wanted, robot, request.base, read);
    moved = group.coordinates_above(goal.link->link);
  }
  for (std::string& one : moved) {
    if (std::ranges::find(request.joints, one) == request.joints.end()) {
      request.joints.push_back(std::move(one));
    }
  }
  return goal;
}

/// The coordinates that a request plans.
std::set<std::string> planned_coordinates(const PlanningRequest& request) {
  std::set<std::string> names(request.joints.begin(), request.joints.end());
  for (const RequestGoal& goal : request.goals) {
    for (const auto& [name, position] : goal.positions) {
      names.insert(name);
    }
  }
  return names;
}

/// Reads the box of the workspace as bounds of planar and floating joints, as MoveIt does.
///
/// A box without volume is one that nothing has set.
void read_workspace(const JsonValue& workspace, const RobotModel& robot, const JsonReader& read,
                    PlanningRequest& request) {
  (void)read.object(workspace, {{"header", "min_corner", "max_corner"}});
  const JsonValue* low = find_filled(workspace, "min_corner");
  const JsonValue* high = find_filled(workspace, "max_corner");
  if (low == nullptr || high == nullptr) {
    return;
  }
  const Eigen::Vector3d from = detail::read_point(*low, read);
  const Eigen::Vector3d to = detail::read_point(*high, read);
  if (!(from.array() < to.array()).all()) {
    return;
  }
  for (const std::string& name : planned_coordinates(request)) {
    const auto found = known_coordinate(robot, name);
    const std::optional<std::size_t> joint = found ? found->joint : robot.find_joint(name);
    const JointType type = joint ? robot.joints()[*joint].type : JointType::fixed;
    const Eigen::Index axes = type == JointType::floating ? 3 : type == JointType::planar ? 2 : 0;
    for (Eigen::Index axis = 0; axis < axes; ++axis) {
      request.bounds[coordinate_name(robot, {*joint, static_cast<std::size_t>(axis)})] = {
          from[axis], to[axis]};
    }
  }
}

}  // namespace

PlanningRequest parse_planning_request(std::string_view text, const std::filesystem::path& source,
                                       const RobotModel& robot,
                                       const std::vector<RobotGroup>& groups) {
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
  result.velocity_scaling = read_scaling(request, "max_velocity_scaling_factor", read);
  result.acceleration_scaling = read_scaling(request, "max_acceleration_scaling_factor", read);
  if (const JsonValue* speed = find(std::get<JsonObject>(request.value), "max_cartesian_speed")) {
    result.cartesian_speed = read.not_negative(*speed);
  }
  result.planning_time = read_planning_time(request, read);
  const MovedGroup group(request, robot, groups, read);
  std::vector<std::string> fixed;
  if (const JsonValue* state = find_filled(request, "start_state")) {
    detail::require_state_keys(*state, read);
    refuse_attached(*state, read);
    if (const JsonValue* joints = find_filled(*state, "joint_state")) {
      detail::MessageState start = detail::read_joint_state(*joints, robot, read);
      result.start = std::move(start.positions);
      fixed = std::move(start.fixed);
    }
    if (const auto zero = read_posed_joints(*state, robot, read, result); !zero.empty()) {
      result.warnings.push_back(detail::zero_quaternion_warning(name, zero));
    }
  }
  refuse_other_constraints(request, read);
  for (const JsonValue& wanted : goals_of(request, read)) {
    result.goals.push_back(read_goal(wanted, robot, group, read, result, fixed));
  }
  if (const JsonValue* workspace = find_filled(request, "workspace_parameters")) {
    read_workspace(*workspace, robot, read, result);
  }
  if (!fixed.empty()) {
    result.warnings.push_back(name + ": " + detail::fixed_joints_warning(std::move(fixed)));
  }
  return result;
}

PlanningRequest read_planning_request(const std::filesystem::path& path, const RobotModel& robot,
                                      const std::vector<RobotGroup>& groups) {
  return parse_planning_request(detail::read_file(path, "a request"), path, robot, groups);
}

Trajectory straight_motion(const RobotModel& robot, const JointPositions& start,
                           const JointPositions& goal, Turning turning, double velocity_scaling) {
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
    const double from =
        found != start.end() ? found->second : default_position(joint, coordinate.index);
    trajectory.joint_names.push_back(name);
    trajectory.points[0].positions.push_back(from);
    trajectory.points[1].positions.push_back(position);
    const bool is_short = turning == Turning::shortest && takes_short_way(robot, coordinate);
    const double way = is_short ? shortest_way(from, position) : position - from;
    if (joint.limits.velocity.value_or(0.0) > 0.0) {
      duration = std::max(duration, std::abs(way) / (*joint.limits.velocity * velocity_scaling));
    }
  }
  // A little longer, so that rounding exceeds no limit.
  trajectory.points[1].time = duration > 0.0 ? duration * (1.0 + 0x1p-40) : 1.0;
  return trajectory;
}

}  // namespace firstcontact
