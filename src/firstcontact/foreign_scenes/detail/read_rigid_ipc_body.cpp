#include <firstcontact/foreign_scenes/detail/read_rigid_ipc_body.h>

#include <algorithm>
#include <array>
#include <string>
#include <variant>

#include <firstcontact/motion/rotation_forms.h>

namespace firstcontact::detail {
namespace {

void read_locks(const JsonObject& entry, const JsonReader& read, RigidIpcBody& body) {
  const JsonValue* value = find(entry, "is_dof_fixed");
  if (value == nullptr) {
    return;
  }
  std::array<bool, 6> locks{};
  if (std::holds_alternative<bool>(value->value)) {
    locks.fill(read.boolean(*value));
  } else {
    const std::string expected =
        "true, false, or six of them: three for translation, three for rotation";
    const JsonArray& elements = read.array(*value, expected);
    if (elements.size() != locks.size()) {
      read.fail_expected(expected, *value);
    }
    std::ranges::transform(elements, locks.begin(),
                           [&](const JsonValue& lock) { return read.boolean(lock); });
  }
  std::copy_n(locks.begin(), 3, body.locked_translation.begin());
  std::copy_n(locks.begin() + 3, 3, body.locked_rotation.begin());
  if (std::ranges::find(locks, false) == locks.end()) {
    body.type = RigidIpcType::fixed;
  }
  for (int k = 0; k < 3; ++k) {
    body.linear_velocity[k] *= body.locked_translation[k] ? 0.0 : 1.0;
    body.angular_velocity[k] *= body.locked_rotation[k] ? 0.0 : 1.0;
  }
}

}  // namespace

RigidIpcBody read_rigid_ipc_body(const JsonObject& entry, RigidIpcKeys& keys) {
  const JsonReader& read = keys.read();
  RigidIpcBody body;
  body.X_WB = {.position = keys.vector_or_zero(entry, "position"),
               .rotation = rotation_from_rpy(keys.degrees_or_zero(entry, "rotation"))};
  body.density = keys.positive_or(entry, "density", body.density);
  body.linear_velocity = keys.vector_or_zero(entry, "linear_velocity");
  body.angular_velocity = keys.degrees_or_zero(entry, "angular_velocity");
  body.force = keys.vector_or_zero(entry, "force");
  body.torque = keys.degrees_or_zero(entry, "torque");
  if (const JsonValue* type = find(entry, "type")) {
    constexpr std::array kTypes{RigidIpcType::fixed, RigidIpcType::kinematic,
                                RigidIpcType::dynamic};
    body.type = kTypes.at(read.word(*type, {{"static", "kinematic", "dynamic"}}));
  }
  read_locks(entry, read, body);
  const JsonValue* until = find(entry, "kinematic_max_time");
  if (until != nullptr && read.number(*until) >= 0.0) {
    body.moves_until = read.number(*until);
  }
  if (const JsonValue* poses = find(entry, "kinematic_poses")) {
    for (const JsonValue& element : read.array(*poses, "an array of poses")) {
      const JsonObject& pose = keys.object(element, {"position", "rotation"});
      body.poses.push_back(
          {.position = keys.vector_or_zero(pose, "position"),
           .rotation = rotation_from_vector(keys.vector_or_zero(pose, "rotation"))});
    }
  }
  return body;
}

}  // namespace firstcontact::detail
