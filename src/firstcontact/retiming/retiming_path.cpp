#include <firstcontact/retiming/retiming_path.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonReader;
using detail::JsonValue;

std::size_t robot_named(const Scene& scene, const std::string& name) {
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    if (scene.robots[k].name == name) {
      return k;
    }
  }
  throw std::invalid_argument("expected a robot of the scene, got " + detail::in_quotes(name));
}

/// One word for each of the joints.
std::vector<bool> read_turning(const JsonValue& moves, std::size_t joints, const JsonReader& read) {
  const auto& members = std::get<detail::JsonObject>(moves.value);
  const JsonValue* turning = find(members, "turning");
  if (turning == nullptr) {
    return std::vector<bool>(joints, false);
  }
  std::vector<bool> turns_short;
  for (const JsonValue& word : read.array(*turning, "an array of words")) {
    turns_short.push_back(read.enumerator<Turning>(word, kTurningWords) == Turning::shortest);
  }
  if (turns_short.size() != joints) {
    read.fail(*turning, "expected a word for each of the " + std::to_string(joints) + " joints");
  }
  return turns_short;
}

std::vector<double> read_waypoint(const JsonValue& value, std::size_t joints,
                                  const JsonReader& read) {
  std::vector<double> waypoint;
  for (const JsonValue& number : read.array(value, "an array of numbers")) {
    waypoint.push_back(read.number(number));
  }
  if (waypoint.size() != joints) {
    read.fail(value, "expected a number for each of the " + std::to_string(joints) +
                         " joints, got " + std::to_string(waypoint.size()));
  }
  return waypoint;
}

void require_version(const JsonValue& root, const JsonReader& read) {
  const JsonValue& version = read.member(root, "firstcontact_path");
  if (read.number(version) != 1.0) {
    read.fail_expected("1, the version of the format", version);
  }
}

}  // namespace

RetimingPath parse_retiming_path(std::string_view text, const std::string& name,
                                 const ReadingOptions& options) {
  const JsonValue root = detail::parse_json(text, name);
  const JsonReader read(root, name);
  require_version(root, read);
  RetimingPath result;
  result.is_approximate = read.word(read.member(root, "verdict"), {{"proven", "approximate"}}) == 1;
  const JsonValue& moves = read.member(root, "moves");
  const auto* members = std::get_if<detail::JsonObject>(&moves.value);
  if (members != nullptr && find(*members, "body") != nullptr) {
    read.fail(moves, "expected the path of a robot, got that of a body, which has no joints");
  }
  const JsonValue& robot = read.member(moves, "robot");
  for (const JsonValue& joint : read.array(read.member(moves, "joints"), "an array of names")) {
    result.path.joint_names.push_back(read.string(joint, "the name of a joint"));
  }
  const std::size_t joints = result.path.joint_names.size();
  const std::vector<bool> turns_short = read_turning(moves, joints, read);
  for (const JsonValue& waypoint :
       read.array(read.member(root, "waypoints"), "an array of waypoints")) {
    result.path.waypoints.push_back(read_waypoint(waypoint, joints, read));
  }
  result.scene = parse_embedded_scene(text, name, 1, options);
  result.scene.text_digest = read.string(read.member(root, "scene_digest"), "a digest");
  result.input_digest = read.string(read.member(root, "input_digest"), "a digest");
  try {
    result.robot = robot_named(result.scene, read.string(robot, "the name of a robot"));
    for (const std::string& joint : result.path.joint_names) {
      (void)find_coordinate(result.scene.robots[result.robot].model, joint);
    }
    require_path(result.path);
  } catch (const std::invalid_argument& error) {
    throw ParseError(name, error.what());
  }
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
  result.robot = name.empty() ? 0 : robot_named(scene, name);
  const SceneRobot& robot = scene.robots[result.robot];
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
  result.path = unwound(std::move(result.path), turns_short);
  result.scene = std::move(scene);
  return result;
}

RetimingPath read_retiming_path(const std::filesystem::path& file, const std::string& robot,
                                const ReadingOptions& options) {
  const std::string name = file.string();
  const std::string text = detail::read_file(file, "a path or a scene");
  const JsonValue root = detail::parse_json(text, name);
  const auto* members = std::get_if<detail::JsonObject>(&root.value);
  if (members != nullptr && find(*members, "firstcontact_path") != nullptr) {
    return parse_retiming_path(text, name, options);
  }
  try {
    return retiming_path_of(parse_scene(text, file, 1, options), robot);
  } catch (const std::invalid_argument& error) {
    throw ParseError(name, error.what());
  }
}

LoadedRetimingScene load_retiming_scene(const RetimingPath& input, ShapeCache& cache) {
  LoadedScene loaded = load_scene(input.scene, cache);
  if (!input.input_digest.empty() && loaded.input_digest != input.input_digest) {
    throw std::invalid_argument(
        "a file of the scene has changed since the path was planned; plan it again");
  }
  RetimingScene where{.scene = *loaded.robots, .robot = input.robot};
  require_resting_surroundings(where);
  return {.loaded = std::move(loaded), .where = std::move(where)};
}

}  // namespace firstcontact
