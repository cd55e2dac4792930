#include <firstcontact/foreign_scenes/detail/rigid_ipc_keys.h>

#include <algorithm>
#include <numbers>
#include <variant>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

bool is_rigid_ipc(const JsonValue& root) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  return object != nullptr && find(*object, kRigidIpcProblem) != nullptr;
}

const JsonObject& RigidIpcKeys::object(const JsonValue& value,
                                       const std::vector<std::string_view>& known) {
  const auto* members = std::get_if<JsonObject>(&value.value);
  if (members == nullptr) {
    read_.fail_expected("an object", value);
  }
  for (const auto& [key, member] : *members) {
    if (!key.starts_with('#') && std::ranges::find(known, key) == known.end()) {
      warnings_.push_back("line " + std::to_string(member.line) + ": unknown key " +
                          in_quotes(key) + " passed over");
    }
  }
  return *members;
}

double RigidIpcKeys::positive_or(const JsonObject& object, std::string_view key,
                                 double otherwise) const {
  const JsonValue* value = find(object, key);
  return value == nullptr ? otherwise : read_.positive(*value);
}

Vector3d RigidIpcKeys::vector_or_zero(const JsonObject& object, std::string_view key) const {
  const JsonValue* value = find(object, key);
  return value == nullptr ? Vector3d(Vector3d::Zero()) : read_.vector3(*value);
}

Vector3d RigidIpcKeys::degrees_or_zero(const JsonObject& object, std::string_view key) const {
  return vector_or_zero(object, key) * (std::numbers::pi / 180.0);
}

}  // namespace firstcontact::detail
