#include <firstcontact/scene_files/detail/read_motion.h>

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/scene_files/detail/read_pose.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

Pose read_optional_pose(const JsonObject& object, std::string_view key, const JsonReader& read) {
  const JsonValue* value = find(object, key);
  return value == nullptr ? Pose{} : read_pose(*value, read);
}

/// Refuses keys of both forms of a motion, which exclude each other.
void refuse_mixed_forms(const JsonObject& object, const std::vector<std::string_view>& rates,
                        const JsonReader& read) {
  for (const std::string_view key : rates) {
    if (const JsonValue* rate = find(object, key)) {
      read.fail(*rate, "expected either \"to\" or " + in_quotes(key) +
                           ", got both; they are two forms of this motion");
    }
  }
}

BodyMotion read_fixed(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object = read.object(value, {{"type", "pose"}});
  return FixedMotion{read_optional_pose(object, "pose", read)};
}

BodyMotion read_constant_velocity(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"type", "from", "to", "translation", "rotation_vector"}});
  const Pose from = read_optional_pose(object, "from", read);
  if (const JsonValue* to = find(object, "to")) {
    refuse_mixed_forms(object, {"translation", "rotation_vector"}, read);
    return TwoPoseMotion{from, read_pose(*to, read), Between::constant_velocity};
  }
  const JsonValue* translation = find(object, "translation");
  const JsonValue* rotation_vector = find(object, "rotation_vector");
  if (translation == nullptr && rotation_vector == nullptr) {
    read.fail(value, "expected \"to\", or \"translation\" and \"rotation_vector\", got neither");
  }
  ConstantVelocityMotion motion{.from = from};
  if (translation != nullptr) {
    motion.translation = read.vector3(*translation);
  }
  if (rotation_vector != nullptr) {
    motion.rotation_vector = read.vector3(*rotation_vector);
  }
  return motion;
}

Eigen::Vector3d read_axis_direction(const JsonValue& value, const JsonReader& read) {
  Eigen::Vector3d direction = read.vector3(value);
  if (direction.isZero(0.0)) {
    read.fail(value, "expected a direction of any length but zero");
  }
  return direction;
}

BodyMotion read_screw(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object = read.object(
      value, {{"type", "from", "to", "axis_point", "axis_direction", "angle", "translation"}});
  const Pose from = read_optional_pose(object, "from", read);
  if (const JsonValue* to = find(object, "to")) {
    refuse_mixed_forms(object, {"axis_point", "axis_direction", "angle", "translation"}, read);
    return TwoPoseMotion{from, read_pose(*to, read), Between::screw};
  }
  const JsonValue* angle = find(object, "angle");
  const JsonValue* translation = find(object, "translation");
  if (angle == nullptr && translation == nullptr) {
    read.fail(value, "expected \"to\", or an axis with \"angle\" and \"translation\", got neither");
  }
  ScrewMotion motion{.from = from};
  motion.axis_direction = read_axis_direction(read.member(value, "axis_direction"), read);
  if (const JsonValue* axis_point = find(object, "axis_point")) {
    motion.axis_point = read.vector3(*axis_point);
  }
  motion.angle = angle == nullptr ? 0.0 : read.number(*angle);
  motion.translation = translation == nullptr ? 0.0 : read.number(*translation);
  return motion;
}

std::vector<double> read_times(const JsonValue& value, const JsonReader& read) {
  std::vector<double> times;
  for (const JsonValue& element : read.array(value, "an array of times")) {
    const double time = read.not_negative(element);
    if (!times.empty() && !(time > times.back())) {
      read.fail_expected("a time later than the one before, " + write_json(times.back()), element);
    }
    times.push_back(time);
  }
  return times;
}

BodyMotion read_waypoints(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object = read.object(value, {{"type", "times", "poses", "between"}});
  WaypointMotion motion{.times = read_times(read.member(value, "times"), read), .poses = {}};
  const JsonValue& poses = read.member(value, "poses");
  for (const JsonValue& pose : read.array(poses, "an array of poses")) {
    motion.poses.push_back(read_pose(pose, read));
  }
  if (motion.poses.size() != motion.times.size() || motion.poses.empty()) {
    read.fail(poses, "expected as many poses as times, and at least one, got " +
                         std::to_string(motion.poses.size()) + " poses and " +
                         std::to_string(motion.times.size()) + " times");
  }
  if (const JsonValue* between = find(object, "between")) {
    motion.between = read.enumerator<Between>(*between, kBetweenWords);
  }
  return motion;
}

BodyMotion read_vertices(const JsonValue& value, const JsonReader& read) {
  for (const std::string_view key : {"from", "pose"}) {
    if (const JsonValue* pose = find(std::get<JsonObject>(value.value), key)) {
      read.fail(*pose, "expected no " + in_quotes(key) +
                           " here: the vertices of the shape say where they begin");
    }
  }
  (void)read.object(value, {{"type", "to"}});
  VertexMotion motion;
  for (const JsonValue& vertex :
       read.array(read.member(value, "to"), "an array of places, one for each vertex")) {
    motion.to.push_back(read.vector3(vertex));
  }
  return motion;
}

}  // namespace

BodyMotion read_motion(const JsonValue& value, const JsonReader& read) {
  if (!std::holds_alternative<JsonObject>(value.value)) {
    read.fail_expected("an object with \"type\"", value);
  }
  const JsonValue& type = read.member(value, "type");
  switch (read.word(type, {{"fixed", "constant_velocity", "screw", "waypoints", "vertices"}})) {
    case 0:
      return read_fixed(value, read);
    case 1:
      return read_constant_velocity(value, read);
    case 2:
      return read_screw(value, read);
    case 3:
      return read_waypoints(value, read);
    default:
      return read_vertices(value, read);
  }
}

}  // namespace firstcontact::detail
