#include <firstcontact/verification/detail/moving_scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/scene/detail/resting_position.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// [-]  Greatest difference of the length of a quaternion from 1, as in scenes.
constexpr double kUnit = 1e-6;

/// [rad or m]  Most by which joints may be beyond their limits, as in limit_report().
constexpr double kLimitTolerance = 1e-9;

/// Requires that no joint that mimics a coordinate with the short way shows whole turns.
void require_turning(const RobotModel& model, const std::string& name, Turning turning) {
  if (turning == Turning::shortest && !takes_short_way(model, find_coordinate(model, name))) {
    throw BrokenPath("The coordinate " + in_quotes(name) + " cannot turn the short way.");
  }
}

/// Requires positions within limits; straight edges and mimic joints keep the limits of the ends.
void require_limits(const RobotModel& model, std::size_t joint, double position) {
  const Joint& moved = model.joints()[joint];
  const bool has_limits = moved.type == JointType::revolute || moved.type == JointType::prismatic ||
                          moved.type == JointType::screw;
  const double slack = kLimitTolerance * (1.0 + std::abs(position));
  if (has_limits && (position < moved.limits.lower.value_or(position) - slack ||
                     position > moved.limits.upper.value_or(position) + slack)) {
    throw BrokenPath("A waypoint has joint " + in_quotes(moved.name) + " at " +
                     write_json(position) + ", outside of its limits.");
  }
  for (std::size_t other = 0; other < model.joints().size(); ++other) {
    const std::optional<Mimic>& mimic = model.joints()[other].mimic;
    if (mimic && mimic->joint == moved.name) {
      require_limits(model, other, mimic->multiplier * position + mimic->offset);
    }
  }
}

LoadedScene load(const PlannedPath& path) {
  ShapeCache cache;
  return load_scene_of(path, cache);
}

/// Whether a robot holds a body at a pose in its link: a motion of the body then has no meaning.
bool is_held(const Scene& scene, std::size_t body) {
  return std::ranges::any_of(scene.robots, [&](const SceneRobot& robot) {
    return std::ranges::any_of(robot.attached, [&](const SceneAttachment& held) {
      return held.body == body && held.pose;
    });
  });
}

/// Requires that all but the mover and what is held rest: the file is about edges of the mover
/// alone.
///
/// A state of joints is a trajectory of one point.
void require_at_rest(const Scene& scene) {
  const auto rests = [](const BodyMotion& motion) {
    return std::holds_alternative<FixedMotion>(motion);
  };
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (!rests(scene.bodies[k].motion) && !is_held(scene, k)) {
      throw BrokenPath("The body " + in_quotes(scene.bodies[k].name) + " moves by itself.");
    }
  }
  for (const SceneRobot& robot : scene.robots) {
    if (!rests(robot.base) || robot.trajectory.points.size() > 1) {
      throw BrokenPath("The robot " + in_quotes(robot.name) + " moves by itself.");
    }
  }
}

void require_unheld_motion(const Scene& scene) {
  for (const SceneRobot& robot : scene.robots) {
    for (const SceneAttachment& held : robot.attached) {
      if (held.from_time != 0.0 || held.to_time) {
        throw BrokenPath("The robot " + in_quotes(robot.name) +
                         " holds a body for a part of the time.");
      }
    }
  }
}

/// Requires that the mover has no motion of its own.
void require_own_rest(bool rests, const std::string& name) {
  if (!rests) {
    throw BrokenPath("The mover " + in_quotes(name) + " moves by itself.");
  }
}

std::size_t member_count(const Scene& scene) {
  std::size_t members = scene.bodies.size();
  for (const SceneRobot& robot : scene.robots) {
    members += robot.model.links().size();
  }
  return members;
}

/// Whether the trajectory of a robot moves a joint, or the one that it mimics.
bool is_in_trajectory(const SceneRobot& robot, std::size_t joint) {
  while (robot.model.joints()[joint].mimic) {
    joint = robot.model.find_joint(robot.model.joints()[joint].mimic->joint).value();
  }
  return std::ranges::any_of(robot.trajectory.joint_names, [&](const std::string& name) {
    return find_coordinate(robot.model, name).joint == joint;
  });
}

}  // namespace

MovingScene::MovingScene(const PlannedPath& path) : path_(path), loaded_(load(path)) {
  require_unheld_motion(loaded_.scene);
  if (path.times.empty()) {
    require_at_rest(loaded_.scene);
    const std::size_t edges = path.waypoints.size() - 1;
    loaded_.scene.duration = static_cast<double>(std::max<std::size_t>(edges, 1));
  } else {
    require_times();
  }
  moves_.assign(member_count(loaded_.scene), false);
  is_rotation_.assign(path.joints.size(), false);
  if (!path.body.empty()) {
    find_body();
  }
  if (!path.robots.empty()) {
    move_robots();
  }
  if (!path.body.empty()) {
    move_body();
  }
}

std::array<double, 7> MovingScene::body_numbers(const std::vector<double>& row) const {
  std::array<double, 7> numbers{};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    numbers.at(k) = row.at(body_columns_.at(k));
  }
  return numbers;
}

bool MovingScene::is_of_body(std::size_t column) const {
  return body_ && std::ranges::find(body_columns_, column) != body_columns_.end();
}

std::optional<std::array<std::size_t, 4>> MovingScene::rotation_columns(std::size_t column) const {
  const auto found = rotations_.find(column);
  return found == rotations_.end() ? std::nullopt : std::optional(found->second);
}

double MovingScene::time(std::size_t waypoint) const {
  return path_.times.empty() ? static_cast<double>(waypoint) : path_.times.at(waypoint);
}

void MovingScene::require_times() const {
  const std::vector<double>& times = path_.times;
  const bool increase =
      std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
  // The proof divides by the duration: equal quotients would leave an edge of no length.
  const double duration = loaded_.scene.duration;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    if (!(times[k] / duration < times[k + 1] / duration)) {
      throw BrokenPath("The times of the path are so close that doubles do not tell them apart.");
    }
  }
  if (times.size() != path_.waypoints.size() || times.size() < 2 || !increase ||
      times.front() != 0.0 || times.back() != loaded_.scene.duration) {
    throw BrokenPath("The times of the path do not run from 0 to the duration of its scene.");
  }
}

void MovingScene::move_robots() {
  Scene& scene = loaded_.scene;
  std::vector<std::size_t> numbers;
  for (const std::string& name : path_.robots) {
    const auto found = std::ranges::find(scene.robots, name, &SceneRobot::name);
    if (found == scene.robots.end()) {
      throw BrokenPath("The scene has no robot " + in_quotes(name) + ".");
    }
    require_own_rest(
        std::holds_alternative<FixedMotion>(found->base) && found->trajectory.joint_names.empty(),
        found->name);
    numbers.push_back(static_cast<std::size_t>(found - scene.robots.begin()));
    found->trajectory = Trajectory{.joint_names = {}, .points = {}};
    for (std::size_t k = 0; k < path_.waypoints.size(); ++k) {
      found->trajectory.points.push_back({.time = time(k), .positions = {}});
    }
  }
  std::array<std::optional<std::size_t>, 7> of_body;
  for (std::size_t column = 0; column < path_.joints.size(); ++column) {
    const RobotName split = split_mover_name(scene, {numbers, body_}, path_.joints[column]);
    if (split.which == numbers.size()) {
      const std::optional<std::size_t> index = pose_index(split.name);
      if (!index || of_body.at(*index)) {
        throw BrokenPath("The path has " + in_quotes(path_.joints[column]) +
                         ", which is no number of a pose, or stands twice.");
      }
      of_body.at(*index) = column;
      continue;
    }
    const std::size_t number = numbers[split.which];
    move_joint(column, scene.robots[number], number, split.name);
  }
  find_rotations();
  for (std::size_t k = 0; k < of_body.size() && body_; ++k) {
    if (!of_body.at(k)) {
      throw BrokenPath("The path has a part of the pose of body " + in_quotes(path_.body) +
                       " only.");
    }
    body_columns_.at(k) = *of_body.at(k);
  }
  for (const std::size_t number : numbers) {
    if (scene.robots[number].trajectory.joint_names.empty()) {
      throw BrokenPath("The path moves no joint of robot " + in_quotes(scene.robots[number].name) +
                       ".");
    }
    find_moving(scene.robots[number], number);
  }
}

/// Lets a joint of a robot go through its column of the waypoints.
void MovingScene::move_joint(std::size_t column, SceneRobot& robot, std::size_t number,
                             const std::string& name) {
  const JointCoordinate which = find_coordinate(robot.model, name);
  if (robot.model.joints()[which.joint].mimic) {
    throw BrokenPath("The joint " + in_quotes(name) + " mimics another.");
  }
  is_rotation_[column] =
      robot.model.joints()[which.joint].type == JointType::floating && which.index >= 3;
  require_turning(robot.model, name, path_.turnings.at(column));
  if (path_.waypoints.front().at(column) != resting_position(robot, name)) {
    throw BrokenPath("The path does not begin where its scene has joint " +
                     in_quotes(path_.joints[column]) + ".");
  }
  for (const std::string& other : robot.trajectory.joint_names) {
    if (find_coordinate(robot.model, other) == which) {
      throw BrokenPath("The path has joint " + in_quotes(path_.joints[column]) + " twice.");
    }
  }
  robot.trajectory.joint_names.push_back(name);
  for (std::size_t k = 0; k < path_.waypoints.size(); ++k) {
    const double position = path_.waypoints[k].at(column);
    require_limits(robot.model, which.joint, position);
    robot.trajectory.points[k].positions.push_back(position);
  }
  turnings_[number][name] = path_.turnings.at(column);
}

/// Finds the whole quaternion of each floating joint among the columns.
void MovingScene::find_rotations() {
  constexpr std::array<const char*, 4> kEndings = {"/rot_w", "/rot_x", "/rot_y", "/rot_z"};
  for (std::size_t column = 0; column < path_.joints.size(); ++column) {
    if (!is_rotation_[column]) {
      continue;
    }
    const std::string joint = path_.joints[column].substr(0, path_.joints[column].rfind('/'));
    std::array<std::size_t, 4> columns{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto found = std::ranges::find(path_.joints, joint + kEndings.at(k));
      if (found == path_.joints.end()) {
        throw BrokenPath("The path has a part of the quaternion of joint " + in_quotes(joint) +
                         " only.");
      }
      columns.at(k) = static_cast<std::size_t>(found - path_.joints.begin());
    }
    rotations_[columns[0]] = columns;
    for (const std::vector<double>& q : path_.waypoints) {
      const auto at = [&](std::size_t k) { return q.at(columns.at(k)); };
      if (!(std::abs(std::hypot(std::hypot(at(0), at(1)), std::hypot(at(2), at(3))) - 1.0) <=
            kUnit)) {
        throw BrokenPath("A waypoint has a quaternion that is not of length 1.");
      }
    }
  }
}

void MovingScene::find_moving(const SceneRobot& robot, std::size_t number) {
  const std::size_t first = first_member(loaded_.scene, number);
  for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
    moves_[first + link] = !path_.times.empty();  // Other members come near any resting one.
    for (auto joint = robot.model.parent_joint(link); joint && !moves_[first + link];
         joint = robot.model.parent_joint(robot.model.parent_link(*joint))) {
      moves_[first + link] = is_in_trajectory(robot, *joint);
    }
  }
  for (const SceneAttachment& held : robot.attached) {
    moves_[held.body] = moves_[first + held.link];
  }
}

void MovingScene::find_body() {
  const std::vector<Body>& bodies = loaded_.scene.bodies;
  const auto body = std::ranges::find(bodies, path_.body, &Body::name);
  if (body == bodies.end()) {
    throw BrokenPath("The scene has no body " + in_quotes(path_.body) + ".");
  }
  body_ = static_cast<std::size_t>(body - bodies.begin());
}

void MovingScene::move_body() {
  Scene& scene = loaded_.scene;
  const std::size_t number = *body_;
  Body* const body = &scene.bodies[number];
  for (const SceneRobot& robot : scene.robots) {
    for (const SceneAttachment& held : robot.attached) {
      if (held.body == number) {
        throw BrokenPath("A robot holds the body " + in_quotes(path_.body) + ".");
      }
    }
  }
  require_own_rest(std::holds_alternative<FixedMotion>(body->motion), body->name);
  require_begin(std::get<FixedMotion>(body->motion).pose);
  WaypointMotion motion;
  for (const std::vector<double>& row : path_.waypoints) {
    const std::array<double, 7> q = body_numbers(row);
    if (!(std::abs(std::hypot(std::hypot(q.at(3), q.at(4)), std::hypot(q.at(5), q.at(6))) - 1.0) <=
          kUnit)) {
      throw BrokenPath("A waypoint has a quaternion that is not of length 1.");
    }
    motion.times.push_back(time(motion.times.size()));
    motion.poses.push_back(pose_of_positions(q));
  }
  body->motion = motion;
  moves_[number] = true;
}

void MovingScene::require_begin(const Pose& pose) const {
  const std::array<double, 7> q = body_numbers(path_.waypoints.front());
  const Eigen::Quaterniond& r = pose.rotation;
  if (Eigen::Vector3d(q.at(0), q.at(1), q.at(2)) != pose.position ||
      Eigen::Vector4d(q.at(3), q.at(4), q.at(5), q.at(6)) !=
          Eigen::Vector4d(r.w(), r.x(), r.y(), r.z())) {
    throw BrokenPath("The path does not begin where its scene has body " + in_quotes(path_.body) +
                     ".");
  }
}

}  // namespace firstcontact::detail
