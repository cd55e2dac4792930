#include <firstcontact/planning/plan_scene.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/planning/detail/body_box.h>
#include <firstcontact/planning/detail/link_goals.h>
#include <firstcontact/planning/detail/plan_goals.h>
#include <firstcontact/planning/detail/planned_speeds.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::in_quotes;

[[noreturn]] void refuse_plan(const std::string& what) { throw std::invalid_argument(what); }

bool moves_by_itself(const SceneRobot& robot) {
  return !std::holds_alternative<FixedMotion>(robot.base) ||
         (robot.trajectory.points.size() > 1 && !robot.trajectory.joint_names.empty());
}

bool is_planned(const PlanQuestion& question, std::size_t robot) {
  return std::ranges::find(question.robots, robot) != question.robots.end();
}

/// Whether a robot holds a body, whose own motion then has no meaning.
bool is_held(const Scene& scene, std::size_t body) {
  return std::ranges::any_of(scene.robots, [&](const SceneRobot& robot) {
    return std::ranges::any_of(robot.attached, [&](const SceneAttachment& held) {
      return held.body == body && held.pose;
    });
  });
}

/// The name of something other than the movers that moves; none where all else rests.
std::optional<std::string> what_moves(const Scene& scene, const PlanQuestion& question) {
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    if (!is_planned(question, k) && moves_by_itself(scene.robots[k])) {
      return "robot " + in_quotes(scene.robots[k].name);
    }
  }
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (question.body != k && !is_held(scene, k) &&
        !std::holds_alternative<FixedMotion>(scene.bodies[k].motion)) {
      return "body " + in_quotes(scene.bodies[k].name);
    }
  }
  return std::nullopt;
}

/// Adds the first point of a trajectory to the positions at which the robot rests.
void rest_at_begin(SceneRobot& robot) {
  const Trajectory& trajectory = robot.trajectory;
  for (std::size_t k = 0; k < trajectory.joint_names.size(); ++k) {
    robot.state[trajectory.joint_names[k]] = trajectory.points.front().positions[k];
  }
  robot.trajectory = Trajectory{.joint_names = {}, .points = {TrajectoryPoint{}}};
}

void require_all_the_time(const Scene& scene, const SceneRobot& robot) {
  for (const SceneAttachment& held : robot.attached) {
    if (held.from_time > 0.0 || (held.to_time && *held.to_time < scene.duration)) {
      refuse_plan("body " + in_quotes(scene.bodies[held.body].name) +
                  " is held for a part of the time only; a path is planned for what is held all "
                  "the time");
    }
  }
}

/// Names of the bodies that forces would move in a simulation.
std::vector<std::string> frozen_by_plan(const Scene& scene, const PlanQuestion& question) {
  std::vector<std::string> frozen;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (scene.bodies[k].free && question.body != k) {
      frozen.push_back("body " + in_quotes(scene.bodies[k].name) +
                       " has \"dynamics\": here it rests where it is");
    }
  }
  return frozen;
}

/// Adds the start of the question to the positions at which its robots rest.
void rest_at_start(const PlanQuestion& question, Scene& scene) {
  for (const auto& [name, position] : question.start) {
    const detail::RobotName split = detail::split_robot_name(scene, question.robots, name);
    SceneRobot& robot = scene.robots[question.robots[split.which]];
    robot.state[coordinate_name(robot.model, find_coordinate(robot.model, split.name))] = position;
  }
}

/// A pose with a quaternion of length 1, as places of a body have it.
///
/// Rounded decimals are scaled. A quaternion of length 1 comes back bit for bit.
Pose with_unit_quaternion(Pose pose) {
  constexpr double kUnit = 1e-7;  // Stricter than ConfigurationSpace::defect().
  if (std::abs(pose.rotation.norm() - 1.0) > kUnit) {
    pose.rotation.normalize();
  }
  return pose;
}

/// Gives the planned body the pose in which it starts.
void rest_at_start(const PlanQuestion& question, Body& body) {
  if (question.start_pose) {
    body.motion = FixedMotion{*question.start_pose};
  }
  auto* at_rest = std::get_if<FixedMotion>(&body.motion);
  if (at_rest == nullptr) {
    refuse_plan("body " + in_quotes(body.name) +
                " moves by itself and is to be planned; give it a \"start\" or a pose at rest");
  }
  at_rest->pose = with_unit_quaternion(at_rest->pose);
}

/// The scene with the movers at rest at their start, and the margin of the question.
///
/// All other bodies rest or move by themselves.
Scene resting_scene(Scene scene, const PlanQuestion& question) {
  const bool keeps_times = what_moves(scene, question).has_value();
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    SceneRobot& robot = scene.robots[k];
    require_all_the_time(scene, robot);
    for (SceneAttachment& held : robot.attached) {
      held.to_time.reset();
    }
    if (is_planned(question, k) || !moves_by_itself(robot)) {
      rest_at_begin(robot);
    }
    if (is_planned(question, k) && !std::holds_alternative<FixedMotion>(robot.base)) {
      refuse_plan("the base of robot " + in_quotes(robot.name) +
                  " moves; a path is planned for a base at rest");
    }
    robot.dynamics.reset();
  }
  rest_at_start(question, scene);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    Body& body = scene.bodies[k];
    if (std::holds_alternative<VertexMotion>(body.motion)) {
      refuse_plan("body " + in_quotes(body.name) +
                  " deforms; expected rigid bodies, among which a path can be proven again");
    }
    body.free.reset();
    if (question.body == k) {
      rest_at_start(question, body);
    }
  }
  scene.options.margin = question.margin.value_or(scene.options.margin);
  scene.options.start_contacts = StartContacts::report;
  scene.simulation.reset();
  scene.plan.reset();
  if (!keeps_times) {
    scene.duration = 1.0;
  }
  return scene;
}

void require_movers(const Scene& scene, const PlanQuestion& question) {
  if (question.robots.empty() != question.body.has_value()) {
    refuse_plan("expected a robot or a body that moves");
  }
  const auto is_known = [&](std::size_t robot) { return robot < scene.robots.size(); };
  if (!std::ranges::all_of(question.robots, is_known) ||
      (question.body && *question.body >= scene.bodies.size())) {
    refuse_plan("expected a scene with something to move, it has no such robot or body");
  }
  if (std::set(question.robots.begin(), question.robots.end()).size() != question.robots.size()) {
    refuse_plan("expected each robot once");
  }
}

/// Gives held bodies the place in their link that they have at the start; returns whether there are
/// any.
bool freeze_held(const LoadedScene& loaded, Scene& scene) {
  bool any = false;
  for (SceneRobot& robot : scene.robots) {
    for (SceneAttachment& held : robot.attached) {
      const auto stretches = loaded.robots->stretches(held.body);
      const auto* carried = std::get_if<BodyStretch::Carried>(&stretches.front().how);
      if (!held.pose && carried != nullptr) {
        held.pose = carried->X_LB;
        any = true;
      }
    }
  }
  return any;
}

double start_of(const SceneRobot& robot, const JointCoordinate& coordinate) {
  const auto found = robot.state.find(coordinate_name(robot.model, coordinate));
  return found != robot.state.end()
             ? found->second
             : default_position(robot.model.joints()[coordinate.joint], coordinate.index);
}

std::map<std::string, JointMotion> held_motions(const RobotMotion& motion) {
  std::map<std::string, JointMotion> held;
  for (std::size_t joint = 0; joint < motion.model().joints().size(); ++joint) {
    if (const std::optional<JointMotion> given = motion.given(joint)) {
      held.emplace(motion.model().joints()[joint].name, *given);
    }
  }
  return held;
}

void take_times(const Scene& scene, const PlanQuestion& question, PlanScene& plan) {
  if (const std::optional<std::string> moving = what_moves(scene, question)) {
    plan.times = PlanTimes{scene.duration, detail::planned_speeds(question, plan.space, *moving)};
  }
}

/// The space of the question's robots.
ConfigurationSpace space_of_robots(const LoadedScene& loaded, const PlanQuestion& question) {
  const std::vector<std::vector<std::string>> joints =
      detail::planned_joints(loaded.scene, question);
  std::vector<std::string> names;
  std::vector<ConfigurationSpace> spaces;
  for (std::size_t k = 0; k < question.robots.size(); ++k) {
    const RobotMotion& motion = loaded.robots->robot_motion(question.robots[k]);
    names.push_back(loaded.scene.robots[question.robots[k]].name);
    if (joints[k].empty()) {
      refuse_plan("robot " + in_quotes(names.back()) + ": no goal names a joint that moves");
    }
    spaces.push_back(ConfigurationSpace::of_joints(motion.model(), joints[k], held_motions(motion),
                                                   motion.base()));
  }
  ConfigurationSpace space =
      spaces.size() == 1 ? std::move(spaces.front()) : ConfigurationSpace::joined(names, spaces);
  for (const auto& [name, limits] : question.bounds) {
    space.set_limits(name, limits[0], limits[1]);
  }
  return space;
}

ScenePlan plan_of_robots(LoadedScene loaded, const PlanQuestion& question,
                         const std::stop_token& stop) {
  ConfigurationSpace space = space_of_robots(loaded, question);
  Configuration start;
  for (const SpaceCoordinate& coordinate : space.coordinates()) {
    start.push_back(start_of(loaded.scene.robots[question.robots[coordinate.mover]],
                             {coordinate.joint, coordinate.index}));
  }
  for (const SpacePose& pose : space.poses()) {
    for (std::size_t index = 0; index < 7; ++index) {
      start.push_back(
          start_of(loaded.scene.robots[question.robots[pose.mover]], {pose.joint.value(), index}));
    }
  }
  std::vector<Configuration> goals;
  for (const JointPositions& goal : question.goals) {
    goals.push_back(detail::goal_of(loaded.scene, question, space, goal, start));
  }
  PlanScene plan{.scene = *loaded.robots,
                 .robots = question.robots,
                 .space = std::move(space),
                 .contact_pairs = question.contact_pairs};
  take_times(loaded.scene, question, plan);
  ScenePlan made{std::move(loaded), std::move(plan), std::move(start), std::move(goals), {}};
  detail::add_link_goals(made, question, stop);
  return made;
}

/// The scene as its check has it, numbered alike, with the mover as a robot of its own.
RobotScene scene_of_body(const LoadedScene& loaded, std::size_t mover,
                         const ConfigurationSpace& space, const Configuration& start) {
  const Scene& scene = loaded.scene;
  RobotScene made(loaded.robots ? loaded.robots->rules() : loaded.bodies.rules());
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (k == mover) {
      made.add_robot(scene.bodies[k].name, space.motion(start, start));
    } else {
      made.add_body(scene.bodies[k].name, shape_of_body(loaded, k),
                    normalised_motion(scene.bodies[k].motion, scene.duration));
    }
  }
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    const std::size_t robot = made.add_robot(scene.robots[k].name, loaded.robots->robot_motion(k),
                                             scene.robots[k].semantics.disabled);
    for (const auto& [joint, error] : scene.robots[k].tracking_error) {
      made.set_tracking_error(robot, scene.robots[k].model.joints()[joint].name, error);
    }
  }
  if (loaded.robots) {
    for (std::size_t member = 0; member < made.size(); ++member) {
      made.set_padding(member, loaded.robots->padding(member));
    }
    for (const Attachment& attachment : loaded.robots->attachments()) {
      if (attachment.body == mover) {
        refuse_plan("body " + in_quotes(scene.bodies[mover].name) +
                    " is held by a robot; plan the robot");
      }
      made.attach(attachment);
    }
  }
  return made;
}

ScenePlan plan_of_body(LoadedScene loaded, const PlanQuestion& question) {
  const std::size_t mover = *question.body;
  const Body& body = loaded.scene.bodies[mover];
  const Shape& shape = shape_of_body(loaded, mover);
  const Pose start_pose = std::get<FixedMotion>(body.motion).pose;
  Configuration start = configuration_of(start_pose);
  std::vector<Configuration> goals;
  for (const Pose& goal : question.goal_poses) {
    goals.push_back(configuration_of(with_unit_quaternion(goal)));
  }
  const auto space_in = [&](const std::array<Eigen::Vector3d, 2>& box) {
    return ConfigurationSpace::of_body(body.name, shape, box[0], box[1]);
  };
  const auto box_of_scene = [&] {
    const ConfigurationSpace at_start = space_in({start_pose.position, start_pose.position});
    return detail::box_around(scene_of_body(loaded, mover, at_start, start), question.goal_poses);
  };
  ConfigurationSpace space = space_in(question.box ? *question.box : box_of_scene());
  RobotScene scene = scene_of_body(loaded, mover, space, start);
  PlanScene plan{.scene = std::move(scene), .robots = {0}, .space = std::move(space)};
  take_times(loaded.scene, question, plan);
  for (std::size_t member = 0; member < plan.scene.size(); ++member) {
    plan.names.push_back(member_name(loaded.scene, member));
  }
  return {std::move(loaded), std::move(plan), std::move(start), std::move(goals), {}};
}

}  // namespace

ScenePlan make_scene_plan(Scene scene, const PlanQuestion& question, ShapeCache& cache,
                          const std::stop_token& stop) {
  const FloatEnvironmentGuard guard;
  require_movers(scene, question);
  const std::vector<std::string> frozen = frozen_by_plan(scene, question);
  Scene resting = resting_scene(std::move(scene), question);
  LoadedScene loaded = load_scene(resting, cache);
  if (loaded.robots && freeze_held(loaded, resting)) {
    loaded = load_scene(std::move(resting), cache);
  }
  loaded.warnings.insert(loaded.warnings.end(), frozen.begin(), frozen.end());
  ScenePlan made = question.body ? plan_of_body(std::move(loaded), question)
                                 : plan_of_robots(std::move(loaded), question, stop);
  made.plan.contact_pairs = question.contact_pairs;
  const PlanOptions defaults;
  made.options.planner = question.planner.value_or(defaults.planner);
  made.options.contacts = question.contacts.value_or(defaults.contacts);
  made.options.seed = question.seed.value_or(defaults.seed);
  made.options.time = question.time.value_or(defaults.time);
  made.options.tolerance = made.loaded.scene.options.tolerance;
  return made;
}

void require_goals_apart(const ScenePlan& scene) {
  const auto found = std::ranges::find(scene.goals, scene.start);
  if (!scene.plan.times && found != scene.goals.end()) {
    const std::string which = scene.goals.size() == 1
                                  ? "goal"
                                  : "goals[" + std::to_string(found - scene.goals.begin()) + "]";
    refuse_plan("plan." + which + ": expected a goal apart from the start, got the start itself");
  }
}

PlanQuestion question_of_trajectory(const Scene& scene) {
  if (scene.robots.size() != 1) {
    refuse_plan("expected a scene with one robot, got " + std::to_string(scene.robots.size()));
  }
  const Trajectory& trajectory = scene.robots.front().trajectory;
  if (trajectory.joint_names.empty() || trajectory.points.size() < 2) {
    refuse_plan("expected a start and a goal; robot " + in_quotes(scene.robots.front().name) +
                " has no goal");
  }
  PlanQuestion question;
  question.robots = {0};
  question.goals.emplace_back();
  for (std::size_t k = 0; k < trajectory.joint_names.size(); ++k) {
    const std::string& name = trajectory.joint_names[k];
    question.start[name] = trajectory.points.front().positions[k];
    question.goals.front()[name] = trajectory.points.back().positions[k];
  }
  return question;
}

std::vector<NamedBlockingPair> blocked_by_name(const ScenePlan& scene,
                                               const PlanStatistics& statistics) {
  const auto name = [&](std::size_t member) { return member_name(scene.loaded.scene, member); };
  std::vector<NamedBlockingPair> named;
  for (const BlockingPair& blocking : statistics.blocked) {
    named.push_back({{name(blocking.members[0]), name(blocking.members[1])}, blocking.count});
  }
  return named;
}

PlannedPath planned_path(const ScenePlan& scene, const PlanOptions& options,
                         const PlanResult& result) {
  if (result.path.empty()) {
    refuse_plan("expected a result with a path, got none");
  }
  if (scene.plan.space.has_screws()) {
    refuse_plan("expected straight edges of the body; a path file holds no screws");
  }
  constexpr std::uint64_t kSeeds = std::uint64_t{1} << 53;  // JSON keeps whole numbers below this.
  if (options.seed >= kSeeds) {
    refuse_plan("expected a seed below 2^53, which a path file holds, got " +
                std::to_string(options.seed));
  }
  PlannedPath path;
  const Scene& resting = scene.loaded.scene;
  const ConfigurationSpace& space = scene.plan.space;
  path.is_proven = result.verdict == PlanVerdict::proven;
  for (const std::size_t robot : scene.plan.robots) {
    path.robots.push_back(scene.plan.scene.robot_name(robot));
  }
  if (space.is_body()) {
    path.body = std::exchange(path.robots, {}).front();
  }
  for (std::size_t k = 0; k < space.size() && !space.is_body(); ++k) {
    const bool is_short = k < space.coordinates().size() && space.coordinates()[k].turns_short;
    path.joints.push_back(space.number_name(k));
    path.turnings.push_back(is_short ? Turning::shortest : Turning::as_given);
  }
  path.waypoints = result.path;
  path.times = result.times;
  if (path.waypoints.size() > 1) {
    path.clearances = result.clearances;
  }
  for (const std::optional<double>& clearance : result.clearances) {
    if (clearance) {
      path.clearance = std::min(path.clearance.value_or(*clearance), *clearance);
    }
  }
  path.margin = resting.options.margin;
  path.tolerance = options.tolerance;
  path.extra_clearance = options.extra_clearance;
  for (const PlannedContact& one : result.contact_pairs) {
    path.contact_pairs.push_back(
        {{member_name(resting, one.pair.members[0]), member_name(resting, one.pair.members[1])},
         one.pair.policy,
         one.pair.at,
         one.distance});
  }
  path.goals = scene.goals;
  path.goal = result.goal;
  path.distance_to_goal = result.distance_to_goal;
  path.cost = result.cost;
  path.planner = options.planner;
  path.contacts = options.contacts;
  path.seed = options.seed;
  path.time = options.time;
  const PlanStatistics& counts = result.statistics;
  path.statistics = {counts.seconds,   counts.first_path_seconds, counts.iterations,
                     counts.nodes,     counts.edges_checked,      counts.states_checked,
                     counts.undecided, counts.first_cost,         blocked_by_name(scene, counts)};
  path.scene = resting;
  detail::ignore_what_rests(scene.plan, path.scene);
  path.scene.options.tolerance = options.tolerance;
  path.version = version();
  path.input_digest = scene.loaded.input_digest;
  return path;
}

}  // namespace firstcontact
