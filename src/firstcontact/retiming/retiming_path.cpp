#include <firstcontact/retiming/retiming_path.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/scene/detail/resting_position.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

std::size_t robot_named(const Scene& scene, const std::string& name) {
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    if (scene.robots[k].name == name) {
      return k;
    }
  }
  throw std::invalid_argument("expected a robot of the scene, got " + detail::in_quotes(name));
}

/// Requires that a planned path begins where its scene has the robots.
void require_start(const RetimingPath& path) {
  for (std::size_t k = 0; k < path.path.joint_names.size(); ++k) {
    const std::string& joint = path.path.joint_names[k];
    const auto [which, name] = detail::split_robot_name(path.scene, path.robots, joint);
    if (path.path.waypoints.front()[k] !=
        detail::resting_position(path.scene.robots[path.robots[which]], name)) {
      throw std::invalid_argument("the path does not begin where its scene has joint " +
                                  detail::in_quotes(joint) + "; plan it again");
    }
  }
}

/// Refuses a robot's name for a path that moves others, or more.
///
/// @param robot  may be empty
/// @param file   names the path in errors
void require_mover(const RetimingPath& path, const std::string& robot, const std::string& file) {
  std::vector<std::string_view> names;
  for (const std::size_t moving : path.robots) {
    names.push_back(path.scene.robots[moving].name);
  }
  if (!robot.empty() && names != std::vector<std::string_view>{robot}) {
    throw ParseError(file, "expected a path of robot " + detail::in_quotes(robot) +
                               " alone, got one that moves " + detail::listed(names) +
                               "; plan that robot alone, or time them together without its name");
  }
}

/// A contact pair of the path in the loaded scene.
RetimingHold hold_of(const NamedContactPair& pair, const RetimingPath& input,
                     const RobotScene& scene) {
  const std::string names =
      detail::in_quotes(pair.pair[0]) + " and " + detail::in_quotes(pair.pair[1]);
  const std::optional<std::size_t> a = scene.find_member(pair.pair[0]);
  const std::optional<std::size_t> b = scene.find_member(pair.pair[1]);
  if (!a || !b || *a == *b) {
    throw std::invalid_argument("contact_pairs: expected two bodies or links of the scene, got " +
                                names);
  }
  RetimingHold hold{.members = {std::min(*a, *b), std::max(*a, *b)},
                    .distance = pair.distance,
                    .opens_at = {},
                    .at = pair.at};
  if (!scene.margin(hold.members)) {
    throw std::invalid_argument("contact_pairs: " + names + " are not tested");
  }
  if (!(pair.distance > 0.0 && std::isfinite(pair.distance))) {
    throw std::invalid_argument("contact_pairs: expected a distance above 0 of " + names);
  }
  const std::vector<std::vector<double>>& waypoints = input.path.waypoints;
  if (pair.policy == ContactPolicy::must_open) {
    hold.opens_at = pair.at == PathEnd::start ? waypoints[1] : waypoints[waypoints.size() - 2];
  }
  return hold;
}

/// Leaves out waypoints that are where the one before is.
///
/// Such an edge has no length: a plan has one where a pair opens on all of its other edges.
std::vector<std::vector<double>> without_repeats(std::vector<std::vector<double>> waypoints) {
  waypoints.erase(std::unique(waypoints.begin(), waypoints.end()), waypoints.end());
  return waypoints;
}

}  // namespace

RetimingPath parse_retiming_path(std::string_view text, const std::string& name,
                                 const ReadingOptions& options) {
  PlannedPath path = parse_planned_path(text, name, options);
  if (!path.body.empty()) {
    throw ParseError(name, "expected the path of robots, got that of body " +
                               detail::in_quotes(path.body) + ", which has no joints");
  }
  if (!path.times.empty()) {
    throw ParseError(name,
                     "expected a path without times: this one is among bodies that move, and "
                     "is proven for its own times alone");
  }
  RetimingPath result;
  result.is_approximate = !path.is_proven;
  result.path = {std::move(path.joints), without_repeats(std::move(path.waypoints))};
  result.scene = std::move(path.scene);
  result.contact_pairs = std::move(path.contact_pairs);
  result.input_digest = std::move(path.input_digest);
  result.sources = std::move(path.sources);
  std::vector<bool> turns_short;
  for (const Turning turning : path.turnings) {
    turns_short.push_back(turning == Turning::shortest);
  }
  try {
    result.robots.clear();
    for (const std::string& robot : path.robots) {
      result.robots.push_back(robot_named(result.scene, robot));
    }
    require_path(result.path);
    require_start(result);
  } catch (const std::invalid_argument& error) {
    throw ParseError(name, error.what());
  }
  result.named_end = result.path.waypoints.back();
  result.path = unwound(std::move(result.path), turns_short);
  return result;
}

RetimingPath retiming_path_of(Scene scene, const std::string& name) {
  if (scene.robots.empty()) {
    throw std::invalid_argument("expected a scene with a robot, got none");
  }
  if (name.empty() && scene.robots.size() > 1) {
    throw std::invalid_argument("expected the name of the robot, as the scene has " +
                                std::to_string(scene.robots.size()));
  }
  RetimingPath result;
  result.robots = {name.empty() ? 0 : robot_named(scene, name)};
  const SceneRobot& robot = scene.robots[result.robots.front()];
  const Trajectory& trajectory = robot.trajectory;
  if (trajectory.joint_names.empty()) {
    throw std::invalid_argument("robot " + detail::in_quotes(robot.name) +
                                ": expected a trajectory, whose points are the waypoints");
  }
  result.path.joint_names = trajectory.joint_names;
  std::vector<bool> turns_short;
  for (const std::string& joint : trajectory.joint_names) {
    turns_short.push_back(trajectory.turning == Turning::shortest &&
                          takes_short_way(robot.model, find_coordinate(robot.model, joint)));
  }
  for (const TrajectoryPoint& point : trajectory.points) {
    result.path.waypoints.push_back(point.positions);
  }
  require_path(result.path);
  result.named_end = result.path.waypoints.back();
  result.path = unwound(std::move(result.path), turns_short);
  result.scene = std::move(scene);
  return result;
}

RetimingPath read_retiming_path(const std::filesystem::path& file, const std::string& robot,
                                const ReadingOptions& options) {
  return parse_path_or_scene(detail::read_file(file, "a path or a scene"), file, robot, options);
}

RetimingPath parse_path_or_scene(std::string_view text, const std::filesystem::path& file,
                                 const std::string& robot, const ReadingOptions& options) {
  const std::string name = file.string();
  const detail::JsonValue root = detail::parse_json(text, name);
  const auto* members = std::get_if<detail::JsonObject>(&root.value);
  if (members != nullptr && find(*members, "firstcontact_path") != nullptr) {
    RetimingPath path = parse_retiming_path(text, name, options);
    require_mover(path, robot, name);
    return path;
  }
  try {
    return retiming_path_of(parse_scene(text, file, 1, options), robot);
  } catch (const std::invalid_argument& error) {
    throw ParseError(name, error.what());
  }
}

LoadedRetimingScene load_retiming_scene(const RetimingPath& input, ShapeCache& cache) {
  LoadedScene loaded =
      input.input_digest.empty()
          ? load_scene(input.scene, cache)
          : load_planned_scene(input.scene, {input.sources, input.input_digest}, cache);
  RetimingScene where{.scene = *loaded.robots, .robots = input.robots, .holds = {}};
  for (const NamedContactPair& pair : input.contact_pairs) {
    where.holds.push_back(hold_of(pair, input, where.scene));
  }
  require_resting_surroundings(where);
  return {.loaded = std::move(loaded), .where = std::move(where)};
}

}  // namespace firstcontact
