#include <firstcontact/scene/planning_scene.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/scene/detail/joint_trajectory.h>
#include <firstcontact/scene/detail/read_path.h>
#include <firstcontact/scene/detail/ros_message.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::find_filled;
using detail::in_quotes;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

/// The message itself, where another one holds it under one of the keys.
const JsonValue& unwrap(const JsonValue& root, const std::vector<std::string_view>& keys,
                        std::string_view own) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  for (const std::string_view key : keys) {
    const JsonValue* inside = object == nullptr ? nullptr : find(*object, key);
    if (inside != nullptr && find(*object, own) == nullptr) {
      return *inside;
    }
  }
  return root;
}

/// Reads the objects of a planning scene.
class ObjectReader {
 public:
  ObjectReader(const std::filesystem::path& source, std::string_view frame, const JsonReader& read)
      : folders_{.scene = source.parent_path(), .package_roots = {}}, read_(read) {
    for (const std::string_view name : {std::string_view(), std::string_view("world"), frame}) {
      frames_.emplace(name, Pose{});
    }
  }

  void add_frames(const JsonValue& transforms) {
    for (const JsonValue& element : read_.array(transforms, "an array of transforms")) {
      (void)read_.object(element, {{"header", "child_frame_id", "transform"}});
      const std::string name =
          detail::name_of(read_.member(element, "child_frame_id"), "the name of a frame", read_);
      const Pose pose = detail::read_message_pose(read_.member(element, "transform"), read_);
      frames_.insert_or_assign(without_slash(name), detail::compose(frame_of(element), pose));
    }
  }

  void add_object(const JsonValue& value, PlanningScene& scene) {
    const std::string id = new_id(value);
    for (Body& part : parts_of(value, id, frame_of(value))) {
      scene.bodies.push_back(std::move(part));
      scene.object_ids.push_back(id);
    }
  }

  void add_attached(const JsonValue& value, PlanningScene& scene) {
    (void)read_.object(value, {{"link_name", "object", "touch_links", "detach_posture", "weight"}});
    const JsonValue& object = read_.member(value, "object");
    AttachedObject attached{
        .id = new_id(object),
        .link = detail::name_of(read_.member(value, "link_name"), "the name of a link", read_),
        .touch_links = {},
        .parts = {}};
    const JsonValue* frame = frame_name(object);
    const auto* name = frame == nullptr ? nullptr : std::get_if<std::string>(&frame->value);
    if (name == nullptr || without_slash(*name) != attached.link) {
      read_.fail(frame == nullptr ? object : *frame,
                 "expected the frame of the link that holds it, " + in_quotes(attached.link) +
                     (name == nullptr ? ", got none" : ", got " + in_quotes(*name)));
    }
    if (const JsonValue* links = find_filled(value, "touch_links")) {
      for (const JsonValue& link : read_.array(*links, "an array of names of links")) {
        attached.touch_links.push_back(detail::name_of(link, "the name of a link", read_));
      }
    }
    attached.parts = parts_of(object, attached.id, Pose{});
    scene.attached.push_back(std::move(attached));
  }

 private:
  /// The first ROS began some frames with a slash.
  static std::string without_slash(const std::string& name) {
    return name.starts_with('/') ? name.substr(1) : name;
  }

  std::string new_id(const JsonValue& object) {
    std::string id = detail::name_of(read_.member(object, "id"), "the name of an object", read_);
    if (!ids_.insert(id).second) {
      read_.fail(object,
                 "expected an id that no other object has, got " + in_quotes(id) + " again");
    }
    return id;
  }

  /// @param frame  in which the object is
  [[nodiscard]] std::vector<Body> parts_of(const JsonValue& object, const std::string& id,
                                           const Pose& frame) const {
    (void)read_.object(object, {{"id", "header", "pose", "type", "primitives", "primitive_poses",
                                 "meshes", "mesh_poses", "planes", "plane_poses", "operation",
                                 "subframe_names", "subframe_poses"}});
    refuse_others(object);
    const JsonValue* own = find_filled(object, "pose");
    const Pose pose =
        own == nullptr ? frame : detail::compose(frame, detail::read_message_pose(*own, read_));
    std::vector<Body> parts;
    add_parts(object, "primitives", "primitive_poses", pose, parts);
    add_parts(object, "meshes", "mesh_poses", pose, parts);
    if (parts.empty()) {
      read_.fail(object, "expected \"primitives\" or \"meshes\" of the object, got none");
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k].name = parts.size() == 1 ? id : id + "/" + std::to_string(k);
    }
    return parts;
  }

  /// Of a message with a header; may be null.
  [[nodiscard]] static const JsonValue* frame_name(const JsonValue& message) {
    const JsonValue* header = find_filled(message, "header");
    return header == nullptr ? nullptr : find_filled(*header, "frame_id");
  }

  [[nodiscard]] Pose frame_of(const JsonValue& message) const {
    const JsonValue* frame = frame_name(message);
    const auto* name = frame == nullptr ? nullptr : std::get_if<std::string>(&frame->value);
    if (name == nullptr) {
      return {};
    }
    const auto found = frames_.find(without_slash(*name));
    if (found == frames_.end()) {
      std::vector<std::string_view> known;
      for (const auto& entry : frames_) {
        known.push_back(entry.first);
      }
      read_.fail(*frame, "expected a frame that rests (" + detail::listed(known) + "), got " +
                             in_quotes(*name));
    }
    return found->second;
  }

  /// What would touch, if it were understood.
  void refuse_others(const JsonValue& object) const {
    if (const JsonValue* planes = find_filled(object, "planes")) {
      read_.fail(*planes, "expected no planes, which have no end; put a box in their place");
    }
    const JsonValue* operation = find_filled(object, "operation");
    const auto* number = operation == nullptr ? nullptr : std::get_if<double>(&operation->value);
    const auto* word = operation == nullptr ? nullptr : std::get_if<std::string>(&operation->value);
    const bool adds = operation == nullptr || (number != nullptr && *number == 0.0) ||
                      (word != nullptr && (*word == "add" || *word == std::string(1, '\0')));
    if (!adds) {
      read_.fail_expected("operation 0, add", *operation);
    }
  }

  void add_parts(const JsonValue& object, std::string_view shapes_key, std::string_view poses_key,
                 const Pose& X_WO, std::vector<Body>& parts) const {
    const JsonValue* shapes = find_filled(object, shapes_key);
    if (shapes == nullptr) {
      return;
    }
    const JsonArray& elements = read_.array(*shapes, "an array of shapes");
    const JsonValue* poses = find_filled(object, poses_key);
    const JsonArray* pose_of =
        poses == nullptr ? nullptr : &read_.array(*poses, "an array of poses");
    if (pose_of != nullptr && pose_of->size() != elements.size()) {
      read_.fail(*poses, "expected a pose for each of the " + std::to_string(elements.size()) +
                             " " + std::string(shapes_key) + ", got " +
                             std::to_string(pose_of->size()));
    }
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const Pose X_OP =
          pose_of == nullptr ? Pose{} : detail::read_message_pose((*pose_of)[k], read_);
      BodyShape shape = shapes_key == "meshes" ? mesh(elements[k]) : primitive(elements[k]);
      parts.push_back({.name = {},
                       .shape = std::move(shape),
                       .motion = FixedMotion{detail::compose(X_WO, X_OP)}});
    }
  }

  /// shape_msgs/SolidPrimitive: its type is a word or a number from 1.
  [[nodiscard]] BodyShape primitive(const JsonValue& value) const {
    (void)read_.object(value, {{"type", "dimensions", "polygon"}});
    const JsonValue& type = read_.member(value, "type");
    const bool is_number = std::holds_alternative<double>(type.value);
    const std::size_t kind = is_number
                                 ? read_.index(type, 5, "a type of primitive")
                                 : 1 + read_.word(type, {{"box", "sphere", "cylinder", "cone"}});
    switch (kind) {
      case 1: {
        const std::vector<double> size = dimensions(value, {"x", "y", "z"});
        return {.source = BoxShape{{size[0], size[1], size[2]}}};
      }
      case 2:
        return {.source = SphereShape{dimensions(value, {"radius"})[0]}};
      case 3: {
        const std::vector<double> size = dimensions(value, {"height", "radius"});
        return {.source =
                    CylinderShape{.radius = size[1], .length = size[0], .enclosure_error = {}}};
      }
      case 4: {
        const std::vector<double> size = dimensions(value, {"height", "radius"});
        return {.source = ConeShape{.radius = size[1], .length = size[0], .enclosure_error = {}}};
      }
      default:
        read_.fail_expected("1 (box), 2 (sphere), 3 (cylinder) or 4 (cone)", type);
    }
  }

  [[nodiscard]] std::vector<double> dimensions(const JsonValue& value,
                                               const std::vector<std::string_view>& names) const {
    const JsonValue& list = read_.member(value, "dimensions");
    std::vector<double> numbers;
    for (const JsonValue& element : read_.array(list, "an array of lengths")) {
      numbers.push_back(read_.positive(element));
    }
    if (numbers.size() != names.size()) {
      read_.fail(list, "expected " + detail::listed(names) + ", got " +
                           std::to_string(numbers.size()) + " numbers");
    }
    return numbers;
  }

  /// shape_msgs/Mesh, or a file under `resource`.
  [[nodiscard]] BodyShape mesh(const JsonValue& value) const {
    (void)read_.object(value, {{"triangles", "vertices", "resource", "dimensions"}});
    if (const JsonValue* resource = find_filled(value, "resource")) {
      return {.source = MeshFile{detail::read_path(*resource, "a mesh file", folders_, read_),
                                 scale_of(value)}};
    }
    Mesh mesh;
    for (const JsonValue& vertex :
         read_.array(read_.member(value, "vertices"), "an array of vertices")) {
      mesh.vertices.push_back(detail::read_point(vertex, read_));
    }
    const JsonValue& triangles = read_.member(value, "triangles");
    for (const JsonValue& triangle : read_.array(triangles, "an array of triangles")) {
      mesh.triangles.push_back(corners(triangle, mesh.vertices.size()));
    }
    if (mesh.triangles.empty()) {
      read_.fail(triangles, "expected at least one triangle, got none");
    }
    return {.source = std::move(mesh)};
  }

  [[nodiscard]] double scale_of(const JsonValue& mesh) const {
    const JsonValue* scale = find_filled(mesh, "dimensions");
    if (scale == nullptr) {
      return 1.0;
    }
    const Eigen::Vector3d factors = detail::read_point(*scale, read_);
    if (!(factors.x() > 0.0 && factors.x() == factors.y() && factors.x() == factors.z())) {
      read_.fail(*scale, "expected three equal factors > 0");
    }
    return factors.x();
  }

  [[nodiscard]] std::array<std::uint32_t, 3> corners(const JsonValue& triangle,
                                                     std::size_t count) const {
    const JsonValue* named = find_filled(triangle, "vertex_indices");
    const JsonValue& list = named != nullptr ? *named : triangle;
    const JsonArray& indices = read_.array(list, "three vertex indices");
    if (indices.size() != 3) {
      read_.fail_expected("three vertex indices", list);
    }
    std::array<std::uint32_t, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = static_cast<std::uint32_t>(
          read_.index(indices[k], std::max<std::size_t>(count, 1), "a vertex index"));
    }
    return result;
  }

  detail::SceneFolders folders_;
  const JsonReader& read_;
  std::map<std::string, Pose, std::less<>> frames_;
  std::set<std::string> ids_;
};

bool read_flag(const JsonValue& value, const JsonReader& read) {
  const auto* number = std::get_if<double>(&value.value);
  if (number != nullptr && (*number == 0.0 || *number == 1.0)) {
    return *number == 1.0;
  }
  return read.boolean(value);
}

std::vector<std::string> read_names(const JsonValue& matrix, std::string_view key,
                                    const JsonReader& read) {
  std::vector<std::string> names;
  if (const JsonValue* list = find_filled(matrix, key)) {
    for (const JsonValue& name : read.array(*list, "an array of names")) {
      names.push_back(detail::name_of(name, "a name", read));
    }
  }
  return names;
}

/// One row for each name, each as long as there are names: [true, false] or {enabled: [...]}.
void read_entries(const JsonValue& matrix, AllowedCollisions& allowed, const JsonReader& read) {
  const std::vector<std::string> names = read_names(matrix, "entry_names", read);
  if (names.empty()) {
    return;
  }
  const JsonValue& values = read.member(matrix, "entry_values");
  const std::string expected = "a row of " + std::to_string(names.size()) + " for each of the " +
                               std::to_string(names.size()) + " entry_names";
  const JsonArray& rows = read.array(values, expected);
  if (rows.size() != names.size()) {
    read.fail(values, "expected " + expected + ", got " + std::to_string(rows.size()) + " rows");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JsonValue* enabled = find_filled(rows[i], "enabled");
    const JsonValue& list = enabled != nullptr ? *enabled : rows[i];
    const JsonArray& row = read.array(list, expected);
    if (row.size() != names.size()) {
      read.fail_expected(expected, list);
    }
    for (std::size_t j = 0; j < row.size(); ++j) {
      const bool flag = read_flag(row[j], read);
      if (names[i] == names[j]) {
        continue;
      }
      const auto [known, is_new] = allowed.entries.insert(
          {{std::min(names[i], names[j]), std::max(names[i], names[j])}, flag});
      if (!is_new && known->second != flag) {
        read.fail(row[j], "expected the same for " + in_quotes(names[i]) + " and " +
                              in_quotes(names[j]) + " as for them swapped");
      }
    }
  }
}

void read_defaults(const JsonValue& matrix, AllowedCollisions& allowed, const JsonReader& read) {
  const std::vector<std::string> names = read_names(matrix, "default_entry_names", read);
  if (names.empty()) {
    return;
  }
  const JsonValue& values = read.member(matrix, "default_entry_values");
  const JsonArray& flags = read.array(values, "an array of true and false");
  if (flags.size() != names.size()) {
    read.fail(values, "expected a value for each of the " + std::to_string(names.size()) +
                          " default_entry_names, got " + std::to_string(flags.size()));
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    allowed.defaults[names[k]] = read_flag(flags[k], read);
  }
}

/// moveit_msgs/LinkPadding: {link_name: , padding: }
void read_padding(const JsonValue& list, PlanningScene& scene, const JsonReader& read) {
  for (const JsonValue& element : read.array(list, "an array of paddings")) {
    (void)read.object(element, {{"link_name", "padding"}});
    const double padding = read.not_negative(read.member(element, "padding"));
    if (padding > 0.0) {
      scene
          .padding[detail::name_of(read.member(element, "link_name"), "the name of a link", read)] =
          padding;
    }
  }
}

void refuse_scale(const JsonValue& list, const JsonReader& read) {
  for (const JsonValue& element : read.array(list, "an array of scales")) {
    const JsonValue* scale = find_filled(element, "scale");
    if (scale == nullptr || read.number(*scale) != 1.0) {
      read.fail(element, "expected no scale of links but 1; a padding makes them larger");
    }
  }
}

void refuse_octomap(const JsonValue& world, const JsonReader& read) {
  const JsonValue* octomap = find_filled(world, "octomap");
  const JsonValue* inner = octomap == nullptr ? nullptr : find_filled(*octomap, "octomap");
  const JsonValue* data = inner != nullptr     ? find_filled(*inner, "data")
                          : octomap != nullptr ? find_filled(*octomap, "data")
                                               : nullptr;
  if (data != nullptr) {
    read.fail(*data, "expected no octomap; give its points as a body of a scene");
  }
}

/// Of a request.
void refuse_attached(const JsonValue& state, const JsonReader& read) {
  if (const JsonValue* attached = find_filled(state, "attached_collision_objects")) {
    read.fail(*attached, "expected no attached objects here; they belong to the planning scene");
  }
}

PlanningScene to_planning_scene(const JsonValue& root, const std::filesystem::path& source,
                                std::string_view frame, const JsonReader& read) {
  const JsonValue& scene = unwrap(root, {"planning_scene", "scene"}, "world");
  const bool is_world = find_filled(scene, "collision_objects") != nullptr;
  if (!is_world) {
    (void)read.object(scene, {{"name", "robot_state", "robot_model_name", "fixed_frame_transforms",
                               "allowed_collision_matrix", "link_padding", "link_scale",
                               "object_colors", "world", "is_diff"}});
  }
  PlanningScene result;
  ObjectReader objects(source, frame, read);
  if (const JsonValue* transforms = find_filled(scene, "fixed_frame_transforms")) {
    objects.add_frames(*transforms);
  }
  if (const JsonValue* padding = find_filled(scene, "link_padding")) {
    read_padding(*padding, result, read);
  }
  if (const JsonValue* scale = find_filled(scene, "link_scale")) {
    refuse_scale(*scale, read);
  }
  if (const JsonValue* matrix = find_filled(scene, "allowed_collision_matrix")) {
    (void)read.object(
        *matrix, {{"entry_names", "entry_values", "default_entry_names", "default_entry_values"}});
    read_entries(*matrix, result.allowed, read);
    read_defaults(*matrix, result.allowed, read);
  }
  const JsonValue* world = is_world ? &scene : find_filled(scene, "world");
  if (world == nullptr) {
    read.fail(scene, "expected a planning scene with \"world\", got none");
  }
  (void)read.object(*world, {{"collision_objects", "octomap"}});
  refuse_octomap(*world, read);
  if (const JsonValue* list = find_filled(*world, "collision_objects")) {
    for (const JsonValue& object : read.array(*list, "an array of objects")) {
      objects.add_object(object, result);
    }
  }
  const JsonValue* state = find_filled(scene, "robot_state");
  const JsonValue* attached =
      state == nullptr ? nullptr : find_filled(*state, "attached_collision_objects");
  if (attached != nullptr) {
    for (const JsonValue& object : read.array(*attached, "an array of attached objects")) {
      objects.add_attached(object, result);
    }
  }
  return result;
}

/// The pose of the joint between the world and the root link.
Pose read_base(const JsonValue& state, const RobotModel& robot, const JsonReader& read) {
  const JsonValue* joints = find_filled(state, "multi_dof_joint_state");
  const JsonValue* names = joints == nullptr ? nullptr : find_filled(*joints, "joint_names");
  if (names == nullptr) {
    return {};
  }
  const JsonArray& list = read.array(*names, "an array of joint names");
  const JsonValue& transforms = read.member(*joints, "transforms");
  const JsonArray& poses = read.array(transforms, "an array of transforms");
  if (list.size() != 1 || poses.size() != 1) {
    read.fail(transforms,
              "expected one joint, between the world and the robot, with one transform");
  }
  const std::string name = detail::name_of(list[0], "the name of a joint", read);
  if (robot.find_joint(name)) {
    read.fail(list[0], "expected the joint between the world and the robot, got its joint " +
                           in_quotes(name));
  }
  return detail::read_message_pose(poses[0], read);
}

JointPositions read_goal(const JsonValue& request, const RobotModel& robot,
                         const JsonReader& read) {
  const JsonValue& goals = read.member(request, "goal_constraints");
  const JsonArray& list = read.array(goals, "an array of goals");
  if (list.size() != 1) {
    read.fail(goals, "expected one goal, got " + std::to_string(list.size()));
  }
  const JsonValue* constraints = find_filled(list[0], "joint_constraints");
  for (const std::string_view key : {"position_constraints", "orientation_constraints"}) {
    if (find_filled(list[0], key) != nullptr || constraints == nullptr) {
      read.fail(list[0], "expected a goal of joint positions, \"joint_constraints\" alone");
    }
  }
  JointPositions goal;
  for (const JsonValue& constraint : read.array(*constraints, "an array of joint constraints")) {
    (void)read.object(constraint,
                      {{"joint_name", "position", "tolerance_above", "tolerance_below", "weight"}});
    const JsonValue& joint = read.member(constraint, "joint_name");
    const std::string name = detail::name_of(joint, "the name of a joint", read);
    try {
      (void)find_coordinate(robot, name);
    } catch (const std::invalid_argument& error) {
      read.fail(joint, error.what());
    }
    const double position = detail::joint_position(read.member(constraint, "position"), read);
    if (!goal.insert({name, position}).second) {
      read.fail(joint, "expected each joint once, got " + in_quotes(name) + " again");
    }
  }
  return goal;
}

}  // namespace

bool AllowedCollisions::allows(const std::string& name, const std::string& other) const {
  const auto entry = entries.find({std::min(name, other), std::max(name, other)});
  if (entry != entries.end()) {
    return entry->second;
  }
  const auto first = defaults.find(name);
  const auto second = defaults.find(other);
  if (first == defaults.end() && second == defaults.end()) {
    return false;
  }
  return (first == defaults.end() || first->second) && (second == defaults.end() || second->second);
}

PlanningScene parse_planning_scene(std::string_view text, const std::filesystem::path& source,
                                   std::string_view frame) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_tree(text, source);
  return to_planning_scene(root, source, frame, JsonReader(root, name));
}

PlanningScene read_planning_scene(const std::filesystem::path& path, std::string_view frame) {
  return parse_planning_scene(detail::read_file(path, "a planning scene"), path, frame);
}

PlanningRequest parse_planning_request(std::string_view text, const std::filesystem::path& source,
                                       const RobotModel& robot) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_tree(text, source);
  const JsonReader read(root, name);
  const JsonValue& request = unwrap(root, {"motion_plan_request", "request"}, "goal_constraints");
  if (!std::holds_alternative<JsonObject>(request.value)) {
    read.fail_expected("a request, an object with \"start_state\" and \"goal_constraints\"",
                       request);
  }
  PlanningRequest result;
  if (const JsonValue* state = find_filled(request, "start_state")) {
    refuse_attached(*state, read);
    if (const JsonValue* joints = find_filled(*state, "joint_state")) {
      result.start = detail::read_joint_state(*joints, robot, read);
    }
    result.base = read_base(*state, robot, read);
  }
  result.goal = read_goal(request, robot, read);
  return result;
}

PlanningRequest read_planning_request(const std::filesystem::path& path, const RobotModel& robot) {
  return parse_planning_request(detail::read_file(path, "a request"), path, robot);
}

Trajectory straight_motion(const RobotModel& robot, const JointPositions& start,
                           const JointPositions& goal) {
  Trajectory trajectory{.joint_names = {}, .points = {{.time = 0.0}, {.time = 0.0}}};
  double duration = 0.0;
  for (const auto& [name, position] : goal) {
    const Joint& joint = robot.joints()[find_coordinate(robot, name).joint];
    if (joint.mimic) {
      continue;  // It follows.
    }
    const auto found = start.find(name);
    const double from = found != start.end() ? found->second : default_position(joint);
    trajectory.joint_names.push_back(name);
    trajectory.points[0].positions.push_back(from);
    trajectory.points[1].positions.push_back(position);
    if (joint.limits.velocity.value_or(0.0) > 0.0) {
      duration = std::max(duration, std::abs(position - from) / *joint.limits.velocity);
    }
  }
  // A little longer, so that rounding leaves no limit.
  trajectory.points[1].time = duration > 0.0 ? duration * (1.0 + 0x1p-40) : 1.0;
  return trajectory;
}

}  // namespace firstcontact
