/// @file
/// The values of a result as JSON; what is infinite or undefined is null.

#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/write_result.h>
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

inline JsonValue to_json(const Feature& feature) {
  return {.value = JsonObject{{"type", to_json(word(feature.type))},
                              {"index", to_json(std::size_t{feature.index})}}};
}

inline JsonValue to_json(UndecidedReason reason) {
  return reason == UndecidedReason::none ? JsonValue{.value = JsonNull{}} : to_json(word(reason));
}

/// One contact; velocities in m/s.
///
/// @param duration  [s]  of the step
inline JsonObject to_json(const Contact& contact, JsonValue names, double duration) {
  return {{"bodies", std::move(names)},
          {"features", two(to_json(contact.feature_A), to_json(contact.feature_B))},
          {"triangles", two(to_json(std::size_t{contact.feature_A.triangle}),
                            to_json(std::size_t{contact.feature_B.triangle}))},
          {"points", two(to_json(contact.p_WA), to_json(contact.p_WB))},
          {"normal", to_json(contact.n_AB_W)},
          {"distance", to_json(contact.distance)},
          {"normal_velocity", to_json(contact.normal_velocity / duration)}};
}

}  // namespace firstcontact::detail
