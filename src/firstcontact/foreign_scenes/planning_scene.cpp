#include <firstcontact/foreign_scenes/planning_scene.h>

#include <algorithm>
#include <cstddef>
#include <variant>

#include <firstcontact/foreign_scenes/detail/planning_objects.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::find_filled;
using detail::in_quotes;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

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

/// Names that the robot may not have: it is not known here.
JointPositions read_state(const JsonValue& value, const JsonReader& read) {
  JointPositions state;
  for (const detail::NamedPosition& joint : detail::named_positions(value, read)) {
    state[detail::name_of(joint.name, "the name of a joint", read)] =
        detail::joint_position(joint.position, read);
  }
  return state;
}

PlanningScene to_planning_scene(const JsonValue& root, const std::filesystem::path& source,
                                std::string_view frame, const JsonReader& read) {
  const JsonValue& scene = detail::unwrap_message(root, {"planning_scene", "scene"}, "world");
  const bool is_world = find_filled(scene, "collision_objects") != nullptr;
  if (!is_world) {
    (void)read.object(scene, {{"name", "robot_state", "robot_model_name", "fixed_frame_transforms",
                               "allowed_collision_matrix", "link_padding", "link_scale",
                               "object_colors", "world", "is_diff"}});
  }
  PlanningScene result;
  detail::PlanningObjects objects(source, frame, read);
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
  if (const JsonValue* joints = state == nullptr ? nullptr : find_filled(*state, "joint_state")) {
    result.state = read_state(*joints, read);
  }
  if (!objects.with_zero_quaternions().empty()) {
    result.warnings.push_back(
        detail::zero_quaternion_warning(source.string(), objects.with_zero_quaternions()));
  }
  return result;
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

}  // namespace firstcontact
