#include <firstcontact/foreign_scenes/planning_scene.h>

#include <optional>

#include <firstcontact/foreign_scenes/detail/allowed_collisions.h>
#include <firstcontact/foreign_scenes/detail/planning_objects.h>
#include <firstcontact/foreign_scenes/detail/robot_state.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact {
namespace {

using detail::find_filled;
using detail::JsonReader;
using detail::JsonValue;

/// Reads moveit_msgs/LinkPadding: {link_name: , padding: }
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

/// Reads a state. The robot is not known here, so the names may be foreign to it.
JointPositions read_state(const JsonValue& value, const JsonReader& read) {
  JointPositions state;
  for (const detail::NamedPosition& joint : detail::named_positions(value, read)) {
    state[detail::name_of(joint.name, "the name of a joint", read)] =
        detail::joint_position(joint.position, read);
  }
  return state;
}

/// Reads the paddings of the robot's links, and the pairs that may touch.
void read_links(const JsonValue& scene, PlanningScene& result, const JsonReader& read) {
  if (const JsonValue* padding = find_filled(scene, "link_padding")) {
    read_padding(*padding, result, read);
  }
  if (const JsonValue* scale = find_filled(scene, "link_scale")) {
    refuse_scale(*scale, read);
  }
  if (const JsonValue* matrix = find_filled(scene, "allowed_collision_matrix")) {
    result.allowed = detail::read_allowed_collisions(*matrix, read);
  }
}

void read_world(const JsonValue& world, detail::PlanningObjects& objects, PlanningScene& result,
                const JsonReader& read) {
  (void)read.object(world, {{"collision_objects", "octomap"}});
  refuse_octomap(world, read);
  if (const JsonValue* list = find_filled(world, "collision_objects")) {
    for (const JsonValue& object : read.array(*list, "an array of objects")) {
      objects.add_object(object, result);
    }
  }
}

/// Refuses a base that is moved. The planning frame is that of the root link here: objects may be
/// placed by either.
void refuse_moved_base(const JsonValue& state, const JsonReader& read) {
  for (const detail::PosedJoint& joint : detail::read_posed_joints(state, read)) {
    if (!detail::is_identity(joint.pose.pose)) {
      read.fail(joint.transform,
                "expected a robot whose base is the planning frame, but it is moved; move the "
                "objects in its place");
    }
  }
}

void read_robot_state(const JsonValue& state, detail::PlanningObjects& objects,
                      PlanningScene& result, const JsonReader& read) {
  detail::require_state_keys(state, read);
  refuse_moved_base(state, read);
  if (const JsonValue* attached = find_filled(state, "attached_collision_objects")) {
    for (const JsonValue& object : read.array(*attached, "an array of attached objects")) {
      objects.add_attached(object, result);
    }
  }
  if (const JsonValue* joints = find_filled(state, "joint_state")) {
    result.state = read_state(*joints, read);
  }
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
    result.moves_world = objects.moves_world();
  }
  read_links(scene, result, read);
  const JsonValue* world = is_world ? &scene : find_filled(scene, "world");
  if (world == nullptr) {
    read.fail(scene, "expected a planning scene with \"world\", got none");
  }
  read_world(*world, objects, result, read);
  if (const JsonValue* state = find_filled(scene, "robot_state")) {
    read_robot_state(*state, objects, result, read);
  }
  if (!objects.with_zero_quaternions().empty()) {
    result.warnings.push_back(
        detail::zero_quaternion_warning(source.string(), objects.with_zero_quaternions()));
  }
  return result;
}

}  // namespace

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
