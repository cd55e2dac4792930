#include <firstcontact/planning/plan_scene.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
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
#include <firstcontact/planning/detail/resting_scene.h>
#include <firstcontact/robot/detail/given_motions.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/resting_position.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::in_quotes;

[[noreturn]] void refuse_plan(const std::string& what) { throw std::invalid_argument(what); }

void require_movers(const Scene& scene, const PlanQuestion& question) {
  if (question.robots.empty() && !question.body) {
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
  return detail::resting_position(robot, coordinate_name(robot.model, coordinate));
}

/// Among poses of links the numbers are not those of the file.
std::string key_of_goal(const PlanQuestion& question, std::size_t k) {
  const bool has_number = question.lists_goals && question.link_goals.empty();
  return std::string(question.lists_goals ? "plan.goals" : "plan.goal") +
         (has_number ? "[" + std::to_string(k) + "]" : "");
}

void take_times(const Scene& scene, const PlanQuestion& question, PlanScene& plan) {
  if (const std::optional<std::string> moving = detail::what_moves(scene, question)) {
    plan.times = PlanTimes{scene.duration, detail::planned_speeds(question, plan.space, *moving)};
  }
}

/// The spaces of movers, each by itself, and their names.
struct NamedSpaces {
  std::vector<std::string> names = {};
  std::vector<ConfigurationSpace> spaces = {};
};

/// The spaces of the question's robots.
NamedSpaces spaces_of_robots(const LoadedScene& loaded, const PlanQuestion& question) {
  const std::vector<std::vector<std::string>> joints =
      detail::planned_joints(loaded.scene, question);
  NamedSpaces all;
  for (std::size_t k = 0; k < question.robots.size(); ++k) {
    const RobotMotion& motion = loaded.robots->robot_motion(question.robots[k]);
    all.names.push_back(loaded.scene.robots[question.robots[k]].name);
    if (joints[k].empty()) {
      refuse_plan("robot " + in_quotes(all.names.back()) +
                  ": no goal names a joint that moves; name one that is not fixed and mimics none");
    }
    all.spaces.push_back(ConfigurationSpace::of_joints(
        motion.model(), joints[k], detail::given_motions(motion), motion.base()));
  }
  return all;
}

/// Joins the spaces of the movers, within the bounds of the question.
ConfigurationSpace joined_space(NamedSpaces all, const PlanQuestion& question) {
  ConfigurationSpace space = all.spaces.size() == 1
                                 ? std::move(all.spaces.front())
                                 : ConfigurationSpace::joined(all.names, all.spaces);
  for (const auto& [name, limits] : question.bounds) {
    space.set_limits(name, limits[0], limits[1]);
  }
  return space;
}

/// The start of the movers: robots at their states, and the body at its pose.
Configuration start_of(const Scene& scene, const PlanQuestion& question,
                       const ConfigurationSpace& space) {
  const auto robot = [&](std::size_t mover) -> const SceneRobot& {
    return scene.robots[question.robots[mover]];
  };
  Configuration start;
  for (const SpaceCoordinate& coordinate : space.coordinates()) {
    start.push_back(start_of(robot(coordinate.mover), {coordinate.joint, coordinate.index}));
  }
  for (const SpacePose& pose : space.poses()) {
    for (std::size_t index = 0; pose.joint && index < 7; ++index) {
      start.push_back(start_of(robot(pose.mover), {*pose.joint, index}));
    }
  }
  if (question.body) {
    const Configuration place =
        configuration_of(std::get<FixedMotion>(scene.bodies[*question.body].motion).pose);
    start.insert(start.end(), place.begin(), place.end());
  }
  return start;
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

/// The space of the question's body, in its box or in one around the whole scene.
///
/// @param goals  of the body
ConfigurationSpace space_of_body(const LoadedScene& loaded, const PlanQuestion& question,
                                 const std::vector<Pose>& goals) {
  const std::size_t mover = *question.body;
  const Body& body = loaded.scene.bodies[mover];
  const Pose& start = std::get<FixedMotion>(body.motion).pose;
  const auto space_in = [&](const std::array<Eigen::Vector3d, 2>& box) {
    return ConfigurationSpace::of_body(body.name, shape_of_body(loaded, mover), box[0], box[1]);
  };
  if (question.box) {
    return space_in(*question.box);
  }
  const ConfigurationSpace at_start = space_in({start.position, start.position});
  return space_in(
      detail::box_around(scene_of_body(loaded, mover, at_start, configuration_of(start)), goals));
}

/// The robot scene of movers, and the number in it of each.
struct MovedScene {
  RobotScene scene;
  std::vector<std::size_t> robots;
};

/// The scene of the movers, with the body as a robot of its own, before all others.
///
/// @param body  the space of the body; none where robots move alone
MovedScene moved_scene(const LoadedScene& loaded, const PlanQuestion& question,
                       const std::optional<ConfigurationSpace>& body) {
  if (!body) {
    return {*loaded.robots, question.robots};
  }
  const Pose& start = std::get<FixedMotion>(loaded.scene.bodies[*question.body].motion).pose;
  MovedScene made{scene_of_body(loaded, *question.body, *body, configuration_of(start)), {}};
  for (const std::size_t robot : question.robots) {
    made.robots.push_back(robot + 1);
  }
  made.robots.push_back(0);
  return made;
}

/// Gives members the names of the scene: there a planned body is no robot.
void take_names(const LoadedScene& loaded, PlanScene& plan) {
  for (std::size_t member = 0; member < plan.scene.size(); ++member) {
    plan.names.push_back(member_name(loaded.scene, member));
  }
}

/// The plan of robots, or of robots and a body at once.
ScenePlan plan_of_robots(LoadedScene loaded, const PlanQuestion& question,
                         const std::stop_token& stop) {
  NamedSpaces all = spaces_of_robots(loaded, question);
  std::optional<ConfigurationSpace> body;
  if (question.body) {
    const Body& moved = loaded.scene.bodies[*question.body];
    std::vector<Pose> goals;
    for (const JointPositions& goal : question.goals) {
      goals.push_back(detail::pose_of_body(loaded.scene, question, goal,
                                           std::get<FixedMotion>(moved.motion).pose));
    }
    body = space_of_body(loaded, question, goals);
    all.names.push_back(moved.name);
    all.spaces.push_back(*body);
  }
  ConfigurationSpace space = joined_space(std::move(all), question);
  Configuration start = start_of(loaded.scene, question, space);
  std::vector<Configuration> goals;
  for (const JointPositions& goal : question.goals) {
    goals.push_back(detail::goal_of(loaded.scene, question, space, goal, start));
  }
  MovedScene moved = moved_scene(loaded, question, body);
  PlanScene plan{.scene = std::move(moved.scene),
                 .robots = std::move(moved.robots),
                 .space = std::move(space),
                 .contact_pairs = question.contact_pairs};
  take_times(loaded.scene, question, plan);
  if (body) {
    take_names(loaded, plan);
  }
  ScenePlan made{std::move(loaded), std::move(plan), std::move(start), std::move(goals), {}};
  detail::add_link_goals(made, question, stop);
  return made;
}

ScenePlan plan_of_body(LoadedScene loaded, const PlanQuestion& question) {
  std::vector<Configuration> goals;
  for (const Pose& goal : question.goal_poses) {
    goals.push_back(configuration_of(detail::with_unit_quaternion(goal)));
  }
  ConfigurationSpace space = space_of_body(loaded, question, question.goal_poses);
  MovedScene moved = moved_scene(loaded, question, space);
  Configuration start = start_of(loaded.scene, question, space);
  PlanScene plan{.scene = std::move(moved.scene),
                 .robots = std::move(moved.robots),
                 .space = std::move(space)};
  take_times(loaded.scene, question, plan);
  take_names(loaded, plan);
  return {std::move(loaded), std::move(plan), std::move(start), std::move(goals), {}};
}

}  // namespace

ScenePlan make_scene_plan(Scene scene, const PlanQuestion& question, ShapeCache& cache,
                          const std::stop_token& stop) {
  const FloatEnvironmentGuard guard;
  require_movers(scene, question);
  const std::vector<std::string> frozen = detail::frozen_by_plan(scene, question);
  Scene resting = detail::resting_scene(std::move(scene), question);
  LoadedScene loaded = load_scene(resting, cache);
  if (loaded.robots && freeze_held(loaded, resting)) {
    loaded = load_scene(std::move(resting), cache);
  }
  loaded.warnings.insert(loaded.warnings.end(), frozen.begin(), frozen.end());
  ScenePlan made = question.robots.empty() ? plan_of_body(std::move(loaded), question)
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

void require_goals_apart(const ScenePlan& scene, const PlanQuestion& question) {
  const auto found = std::ranges::find(scene.goals, scene.start);
  if (!scene.plan.times && found != scene.goals.end()) {
    refuse_plan(key_of_goal(question, static_cast<std::size_t>(found - scene.goals.begin())) +
                ": expected a goal apart from the start, got the start itself");
  }
}

void require_places(const ScenePlan& scene, const PlanQuestion& question) {
  const auto require = [&](const std::string& key, const Configuration& place) {
    if (const std::optional<std::string> defect = scene.plan.space.defect(place)) {
      refuse_plan(key + ": " + *defect);
    }
  };
  const bool has_start = !question.start.empty() || question.start_pose;
  require(has_start ? "plan.start, or what it does not name" : "the start", scene.start);
  for (std::size_t k = 0; k < scene.goals.size(); ++k) {
    require(key_of_goal(question, k), scene.goals[k]);
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
  for (std::size_t mover = 0; mover < space.mover_count(); ++mover) {
    const std::string& name = scene.plan.scene.robot_name(scene.plan.robots[mover]);
    if (space.is_body(mover)) {
      path.body = name;
    } else {
      path.robots.push_back(name);
    }
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
