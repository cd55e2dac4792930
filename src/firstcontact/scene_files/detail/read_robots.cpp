#include <firstcontact/scene_files/detail/read_robots.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/whole_turn_jumps.h>
#include <firstcontact/scene_files/detail/floating_state.h>
#include <firstcontact/scene_files/detail/read_motion.h>
#include <firstcontact/scene_files/detail/read_pose.h>
#include <firstcontact/scene_files/detail/read_robot_dynamics.h>
#include <firstcontact/scene_files/detail/text_reports.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/fixed_joints.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

namespace firstcontact::detail {
namespace {

/// Reads one robot.
class RobotReader {
 public:
  RobotReader(const SceneFolders& folders, Scene& scene, const JsonReader& read)
      : folders_(folders), scene_(scene), read_(read) {}

  SceneRobot robot(const JsonValue& value) const {
    const JsonObject& object = read_.object(
        value,
        {{"name", "urdf", "srdf", "package_roots", "surface", "base", "base_motion", "trajectory",
          "turning", "unwrap", "state", "attached", "padding", "tracking_error", "dynamics"}});
    const RobotFile urdf = file(value, object);
    SceneRobot robot{.name = read_.string(read_.member(value, "name"), "a name"),
                     .file = urdf,
                     .model = read_robot_model(urdf, {.lenient = scene_.options.lenient})};
    if (const JsonValue* srdf = find(object, "srdf")) {
      robot.srdf = read_path(*srdf, "an SRDF file", folders_, read_);
      const std::string text = read_file(robot.srdf, "an SRDF file");
      robot.semantics = parse_srdf(text, robot.srdf.string(), robot.model);
      robot.srdf_digest = sha256(text);
    }
    robot.base = base(object);
    take_motion(value, object, robot);
    if (const JsonValue* attached = find(object, "attached")) {
      for (const JsonValue& element : read_.array(*attached, "an array of attached bodies")) {
        robot.attached.push_back(attachment(element, robot));
      }
    }
    if (const JsonValue* padding = find(object, "padding")) {
      robot.padding = padding_of(*padding, robot);
    }
    if (const JsonValue* error = find(object, "tracking_error")) {
      robot.tracking_error = tracking_error(*error, robot);
    }
    if (const JsonValue* dynamics = find(object, "dynamics")) {
      if (const JsonValue* motion = find(object, "base_motion")) {
        read_.fail(*motion, "expected \"base\" beside \"dynamics\": where the robot starts from");
      }
      robot.dynamics = read_robot_dynamics(*dynamics, robot, read_);
    }
    return robot;
  }

 private:
  RobotFile file(const JsonValue& value, const JsonObject& object) const {
    RobotFile file{.urdf = read_path(read_.member(value, "urdf"), "a URDF file", folders_, read_),
                   .package_roots = folders_.package_roots};
    if (const JsonValue* roots = find(object, "package_roots")) {
      file.package_roots = read_package_roots(*roots, folders_, read_);
    }
    if (const JsonValue* surface = find(object, "surface")) {
      file.surface = read_.enumerator<RobotSurface>(*surface, kRobotSurfaceWords);
    }
    return file;
  }

  BodyMotion base(const JsonObject& object) const {
    const JsonValue* pose = find(object, "base");
    const JsonValue* motion = find(object, "base_motion");
    if (pose != nullptr && motion != nullptr) {
      read_.fail(*pose, "expected either \"base\" (at rest) or \"base_motion\", got both");
    }
    if (motion == nullptr) {
      return FixedMotion{pose == nullptr ? Pose{} : read_pose(*pose, read_)};
    }
    BodyMotion result = read_motion(*motion, read_);
    if (std::holds_alternative<VertexMotion>(result)) {
      read_.fail(*motion, "expected the motion of a rigid body, got \"vertices\"");
    }
    return result;
  }

  void take_trajectory(const JsonValue& value, SceneRobot& robot) const {
    if (!std::holds_alternative<std::string>(value.value)) {
      robot.trajectory = read_joint_trajectory(value, robot.model, robot.name, read_);
      return;
    }
    const std::filesystem::path path = read_path(value, "a trajectory file", folders_, read_);
    const std::string text = read_file(path, "a trajectory file");
    robot.trajectory = parse_trajectory(text, path, robot.model);
    scene_.text_digest += sha256(text) + '\n';
    scene_.files_read.push_back(path);
    scene_.file_reports.push_back(trajectory_report(path, robot.trajectory));
  }

  void take_turning(const JsonObject& object, SceneRobot& robot) const {
    if (const JsonValue* turning = find(object, "turning")) {
      robot.trajectory.turning = read_.enumerator<Turning>(*turning, kTurningWords);
    }
    const JsonValue* unwrap = find(object, "unwrap");
    if (unwrap != nullptr && read_.boolean(*unwrap)) {
      robot.trajectory = unwrapped(robot.model, std::move(robot.trajectory));
    }
  }

  void require_no_turning(const JsonObject& object) const {
    for (const std::string_view key : {"turning", "unwrap"}) {
      if (const JsonValue* said = find(object, key)) {
        read_.fail(*said, "expected a \"trajectory\" beside " + in_quotes(key) + ", got none");
      }
    }
  }

  void take_motion(const JsonValue& value, const JsonObject& object, SceneRobot& robot) const {
    if (const JsonValue* trajectory = find(object, "trajectory")) {
      take_trajectory(*trajectory, robot);
      take_turning(object, robot);
    } else {
      require_no_turning(object);
      robot.trajectory.points = {TrajectoryPoint{}};
    }
    if (const JsonValue* state = find(object, "state")) {
      take_state(*state, robot);
    }
    try {
      const double last = robot.trajectory.points.back().time;
      (void)joint_motions(robot.model, robot.trajectory, robot.state, last > 0.0 ? last : 1.0);
    } catch (const std::invalid_argument& error) {
      const JsonValue* trajectory = find(object, "trajectory");
      const JsonValue* state = find(object, "state");
      // With neither, a joint rests at a limit that no motion can have.
      read_.fail(trajectory != nullptr ? *trajectory
                 : state != nullptr    ? *state
                                       : value,
                 error.what());
    }
  }

  /// Reads a state of the SRDF by its name, coordinates by theirs, or an array of both.
  void take_state(const JsonValue& value, SceneRobot& robot) const {
    if (const auto* array = std::get_if<JsonArray>(&value.value)) {
      for (const JsonValue& element : *array) {
        take_state(element, robot);
      }
    } else if (const auto* name = std::get_if<std::string>(&value.value)) {
      try {
        for (const auto& [joint, position] : group_state(robot.model, robot.semantics, *name)) {
          robot.state[joint] = position;
        }
      } catch (const std::invalid_argument& error) {
        read_.fail(value, error.what());
      }
    } else if (const auto* positions = std::get_if<JsonObject>(&value.value)) {
      take_positions(*positions, robot);
    } else {
      read_.fail_expected(
          "positions by joint, such as {\"joint\": 0.1}, or the name of a state of "
          "the SRDF",
          value);
    }
  }

  void take_positions(const JsonObject& positions, SceneRobot& robot) const {
    std::vector<std::string> fixed;
    JointPositions own;
    for (const auto& [joint, position] : positions) {
      if (names_fixed_joint(robot.model, joint)) {
        (void)joint_position(position, read_);
        fixed.push_back(joint);
        continue;
      }
      if (const auto pose = floating_positions(robot.model, joint, position, read_)) {
        add_once(*pose, own, position, read_);
        continue;
      }
      try {
        (void)find_coordinate(robot.model, joint);
      } catch (const std::invalid_argument& error) {
        read_.fail(position, error.what());
      }
      add_once({{joint, joint_position(position, read_)}}, own, position, read_);
    }
    for (const auto& [joint, position] : own) {
      robot.state[joint] = position;
    }
    if (!fixed.empty()) {
      scene_.warnings.push_back(robot.name + ": state: " + fixed_joints_warning(std::move(fixed)));
    }
  }

  std::size_t link(const JsonValue& value, std::string_view name, const RobotModel& model) const {
    if (const auto found = model.find_link(name)) {
      return *found;
    }
    std::vector<std::string_view> known;
    for (const Link& link : model.links()) {
      known.push_back(link.name);
    }
    const std::string_view nearest = nearest_word(name, known);
    read_.fail(value, "expected a link of the robot, got " + in_quotes(name) + "; " +
                          (nearest.empty() ? "it has " + listed(known)
                                           : "did you mean " + in_quotes(nearest) + "?"));
  }

  std::size_t body(const JsonValue& value) const {
    const std::string& name = read_.string(value, "the name of a body");
    std::vector<std::string_view> known;
    for (std::size_t k = 0; k < scene_.bodies.size(); ++k) {
      if (scene_.bodies[k].name == name) {
        return k;
      }
      known.push_back(scene_.bodies[k].name);
    }
    const std::string_view nearest = nearest_word(name, known);
    read_.fail(value, "expected the name of a body, got " + in_quotes(name) +
                          (nearest.empty() ? "" : "; did you mean " + in_quotes(nearest) + "?"));
  }

  SceneAttachment attachment(const JsonValue& value, const SceneRobot& robot) const {
    const JsonObject& object =
        read_.object(value, {{"body", "link", "from_time", "to_time", "touch_links", "pose"}});
    const auto link_of = [&](const JsonValue& name) {
      return link(name, read_.string(name, "the name of a link"), robot.model);
    };
    SceneAttachment attachment{.body = body(read_.member(value, "body")),
                               .link = link_of(read_.member(value, "link"))};
    if (scene_.bodies[attachment.body].free) {
      read_.fail(read_.member(value, "body"),
                 "expected a body without \"dynamics\": the link carries it");
    }
    if (std::holds_alternative<VertexMotion>(scene_.bodies[attachment.body].motion)) {
      read_.fail(read_.member(value, "body"),
                 "expected a rigid body, got one that deforms: its motion is \"vertices\"");
    }
    if (const JsonValue* from = find(object, "from_time")) {
      attachment.from_time = read_.not_negative(*from);
    }
    if (const JsonValue* pose = find(object, "pose")) {
      attachment.pose = read_pose(*pose, read_);
      if (attachment.from_time > 0.0) {
        read_.fail(*pose,
                   "expected no \"from_time\" beside \"pose\": the link holds it from the start");
      }
    }
    if (const JsonValue* to = find(object, "to_time")) {
      attachment.to_time = read_.positive(*to);
      if (!(*attachment.to_time > attachment.from_time)) {
        read_.fail_expected("a time later than \"from_time\"", *to);
      }
    }
    if (const JsonValue* links = find(object, "touch_links")) {
      for (const JsonValue& name : read_.array(*links, "an array of names of links")) {
        attachment.touch_links.push_back(link_of(name));
      }
    }
    return attachment;
  }

  std::map<std::size_t, double> padding_of(const JsonValue& value, const SceneRobot& robot) const {
    std::map<std::size_t, double> padding;
    if (const auto* links = std::get_if<JsonObject>(&value.value)) {
      for (const auto& [name, number] : *links) {
        padding[link(number, name, robot.model)] = read_.not_negative(number);
      }
      return padding;
    }
    const double all = read_.not_negative(value);
    for (std::size_t k = 0; k < robot.model.links().size(); ++k) {
      padding[k] = all;
    }
    return padding;
  }

  std::map<std::size_t, TrackingError> tracking_error(const JsonValue& value,
                                                      const SceneRobot& robot) const {
    const auto* joints = std::get_if<JsonObject>(&value.value);
    if (joints == nullptr) {
      return joint_errors(robot.model, read_.not_negative(value));
    }
    std::map<std::size_t, TrackingError> errors;
    for (const auto& [name, number] : *joints) {
      const std::size_t index = moving_joint(number, name, robot.model);
      errors[index] = joint_error(robot.model.joints()[index], read_.not_negative(number));
    }
    return errors;
  }

  /// Finds a joint that moves by itself.
  std::size_t moving_joint(const JsonValue& value, std::string_view name,
                           const RobotModel& model) const {
    const auto found = model.find_joint(name);
    if (!found) {
      try {
        (void)find_coordinate(model, name);  // It reports the nearest name.
      } catch (const std::invalid_argument& error) {
        read_.fail(value, error.what());
      }
    }
    if (!found || model.joints()[*found].type == JointType::fixed || model.joints()[*found].mimic) {
      read_.fail(value,
                 "expected the name of a joint that moves by itself, got " + in_quotes(name));
    }
    return *found;
  }

  const SceneFolders& folders_;
  Scene& scene_;
  const JsonReader& read_;
};

bool is_taken(const Scene& scene, const std::string& name) {
  const auto has_name = [&](const auto& other) { return other.name == name; };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), has_name) ||
         std::any_of(scene.robots.begin(), scene.robots.end(), has_name);
}

/// Refuses links whose name "robot/link" a body or another robot has.
void require_new_links(const SceneRobot& robot, const Scene& scene, const JsonValue& name,
                       const JsonReader& read) {
  for (const Link& link : robot.model.links()) {
    const std::string whole = robot.name + "/" + link.name;
    if (is_taken(scene, whole)) {
      read.fail(name,
                "expected a name by which no link is called as a body or another robot, but " +
                    in_quotes(whole) + " is there already; rename one of them");
    }
  }
}

}  // namespace

void read_robots(const JsonValue& value, const SceneFolders& folders, Scene& scene,
                 const JsonReader& read) {
  const RobotReader reader(folders, scene, read);
  for (const JsonValue& element : read.array(value, "an array of robots")) {
    SceneRobot robot = reader.robot(element);
    if (is_taken(scene, robot.name)) {
      read.fail_expected("a name that no body and no other robot has",
                         read.member(element, "name"));
    }
    require_new_links(robot, scene, read.member(element, "name"), read);
    scene.robots.push_back(std::move(robot));
  }
}

}  // namespace firstcontact::detail
