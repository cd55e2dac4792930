#include <firstcontact/foreign_scenes/detail/planning_objects.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include <firstcontact/foreign_scenes/detail/planning_shapes.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>

namespace firstcontact::detail {
namespace {

/// Removes a leading slash: in the first ROS some names of frames began with one.
std::string without_slash(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

/// Finds the frame of a message with a header; may be null.
const JsonValue* frame_name(const JsonValue& message, const JsonReader& read) {
  const JsonValue* header = find_filled(message, "header");
  if (header == nullptr) {
    return nullptr;
  }
  (void)read.object(*header, {{"seq", "stamp", "frame_id"}});
  return find_filled(*header, "frame_id");
}

}  // namespace

PlanningObjects::PlanningObjects(const std::filesystem::path& source, std::string_view frame,
                                 const JsonReader& read)
    : folders_{.scene = source.parent_path(), .package_roots = {}},
      read_(read),
      planning_frame_(frame) {
  for (const std::string_view name : {std::string_view(), std::string_view("world"), frame}) {
    frames_.emplace(name, Pose{});
  }
}

void PlanningObjects::add_frames(const JsonValue& transforms) {
  for (const JsonValue& element : read_.array(transforms, "an array of transforms")) {
    (void)read_.object(element, {{"header", "child_frame_id", "transform"}});
    const std::string name =
        name_of(read_.member(element, "child_frame_id"), "the name of a frame", read_);
    const Pose pose = compose(frame_of(element), pose_of(read_.member(element, "transform"), name));
    if (without_slash(name) == planning_frame_ && !is_identity(pose)) {
      read_.fail(element, "expected the frame of the root link, " + in_quotes(name) +
                              ", to be the planning frame, but it is moved");
    }
    frames_.insert_or_assign(without_slash(name), pose);
  }
}

bool PlanningObjects::moves_world() const { return !is_identity(frames_.find("world")->second); }

void PlanningObjects::add_object(const JsonValue& value, PlanningScene& scene) {
  const std::string id = new_id(value);
  for (Body& part : parts_of(value, id, frame_of(value))) {
    scene.bodies.push_back(std::move(part));
    scene.object_ids.push_back(id);
  }
}

void PlanningObjects::add_attached(const JsonValue& value, PlanningScene& scene) {
  (void)read_.object(value, {{"link_name", "object", "touch_links", "detach_posture", "weight"}});
  const JsonValue& object = read_.member(value, "object");
  AttachedObject attached{
      .id = new_id(object),
      .link = name_of(read_.member(value, "link_name"), "the name of a link", read_),
      .touch_links = {},
      .parts = {}};
  const JsonValue* frame = frame_name(object, read_);
  const auto* name = frame == nullptr ? nullptr : std::get_if<std::string>(&frame->value);
  if (name == nullptr || without_slash(*name) != attached.link) {
    read_.fail(frame == nullptr ? object : *frame,
               "expected the frame of the link that holds it, " + in_quotes(attached.link) +
                   (name == nullptr ? ", got none" : ", got " + in_quotes(*name)));
  }
  if (const JsonValue* links = find_filled(value, "touch_links")) {
    for (const JsonValue& link : read_.array(*links, "an array of names of links")) {
      attached.touch_links.push_back(name_of(link, "the name of a link", read_));
    }
  }
  attached.parts = parts_of(object, attached.id, Pose{});
  scene.attached.push_back(std::move(attached));
}

std::string PlanningObjects::new_id(const JsonValue& object) {
  std::string id = name_of(read_.member(object, "id"), "the name of an object", read_);
  if (!ids_.insert(id).second) {
    read_.fail(object, "expected an id that no other object has, got " + in_quotes(id) + " again");
  }
  return id;
}

std::vector<Body> PlanningObjects::parts_of(const JsonValue& object, const std::string& id,
                                            const Pose& frame) {
  (void)read_.object(object, {{"id", "header", "pose", "type", "primitives", "primitive_poses",
                               "meshes", "mesh_poses", "planes", "plane_poses", "operation",
                               "subframe_names", "subframe_poses"}});
  refuse_others(object);
  const JsonValue* own = find_filled(object, "pose");
  const Pose pose = own == nullptr ? frame : compose(frame, pose_of(*own, id));
  std::vector<Body> parts;
  add_parts(object, "primitives", "primitive_poses", pose, parts, id);
  add_parts(object, "meshes", "mesh_poses", pose, parts, id);
  if (parts.empty()) {
    read_.fail(object, "expected \"primitives\" or \"meshes\" of the object, got none");
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].name = parts.size() == 1 ? id : id + "/" + std::to_string(k);
  }
  return parts;
}

Pose PlanningObjects::frame_of(const JsonValue& message) const {
  const JsonValue* frame = frame_name(message, read_);
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
    read_.fail(*frame,
               "expected a frame that rests (" + listed(known) + "), got " + in_quotes(*name));
  }
  return found->second;
}

/// Refuses the parts of an object that would touch if they were understood.
void PlanningObjects::refuse_others(const JsonValue& object) const {
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

void PlanningObjects::add_parts(const JsonValue& object, std::string_view shapes_key,
                                std::string_view poses_key, const Pose& X_WO,
                                std::vector<Body>& parts, const std::string& id) {
  const JsonValue* shapes = find_filled(object, shapes_key);
  if (shapes == nullptr) {
    return;
  }
  const JsonArray& elements = read_.array(*shapes, "an array of shapes");
  const JsonValue* poses = find_filled(object, poses_key);
  const JsonArray* pose_list =
      poses == nullptr ? nullptr : &read_.array(*poses, "an array of poses");
  if (pose_list != nullptr && pose_list->size() != elements.size()) {
    read_.fail(*poses, "expected a pose for each of the " + std::to_string(elements.size()) + " " +
                           std::string(shapes_key) + ", got " + std::to_string(pose_list->size()));
  }
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const Pose X_OP = pose_list == nullptr ? Pose{} : pose_of((*pose_list)[k], id);
    BodyShape shape = shapes_key == "meshes" ? read_message_mesh(elements[k], folders_, read_)
                                             : read_primitive(elements[k], read_);
    parts.push_back(
        {.name = {}, .shape = std::move(shape), .motion = FixedMotion{compose(X_WO, X_OP)}});
  }
}

Pose PlanningObjects::pose_of(const JsonValue& message, const std::string& of) {
  const MessagePose read = read_message_pose(message, read_);
  if (read.has_zero_quaternion && std::find(zeros_.begin(), zeros_.end(), of) == zeros_.end()) {
    zeros_.push_back(of);
  }
  return read.pose;
}

}  // namespace firstcontact::detail
