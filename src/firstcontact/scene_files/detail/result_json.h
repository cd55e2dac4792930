/// @file
/// The values of a result as JSON; an infinite or undefined number is null.

#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

inline JsonValue to_json(double number) {
  return std::isfinite(number) ? JsonValue{.value = number} : JsonValue{.value = JsonNull{}};
}

inline JsonValue to_json(std::size_t count) { return to_json(static_cast<double>(count)); }

inline JsonValue to_json(std::string_view text) { return {.value = std::string(text)}; }

inline JsonValue to_json(const Eigen::Vector3d& v) {
  return {.value = JsonArray{to_json(v.x()), to_json(v.y()), to_json(v.z())}};
}

inline JsonValue to_json(std::span<const std::string> texts) {
  JsonArray array;
  for (const std::string& text : texts) {
    array.push_back(to_json(text));
  }
  return {.value = std::move(array)};
}

template <typename T>
JsonValue to_json(const std::optional<T>& value) {
  return value ? to_json(*value) : JsonValue{.value = JsonNull{}};
}

inline JsonValue two(JsonValue first, JsonValue second) {
  return {.value = JsonArray{std::move(first), std::move(second)}};
}

inline JsonValue to_json(UndecidedReason reason) {
  return reason == UndecidedReason::none ? JsonValue{.value = JsonNull{}} : to_json(word(reason));
}

}  // namespace firstcontact::detail
