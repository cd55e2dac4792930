#include <firstcontact/record/detail/json_place.h>

#include <cstddef>

namespace firstcontact::detail {
namespace {

using nlohmann::json;

/// The deepest brackets of a line in which a place of a run is looked for.
constexpr int kDeepest = 8;

/// A key without its quotes, on one line whatever it contains.
std::string printable(const std::string& key) {
  const std::string quoted = json(key).dump();
  return quoted.substr(1, quoted.size() - 2);
}

}  // namespace

std::optional<std::string> place_of(const nlohmann::json& value, const nlohmann::json& root,
                                    int depth) {
  if (&value == &root) {
    return "";
  }
  if (depth == kDeepest) {
    return std::nullopt;
  }
  if (root.is_object()) {
    for (const auto& [key, member] : root.items()) {
      if (const auto place = place_of(value, member, depth + 1)) {
        return "." + printable(key) + *place;
      }
    }
  } else if (root.is_array()) {
    for (std::size_t i = 0; i < root.size(); ++i) {
      if (const auto place = place_of(value, root[i], depth + 1)) {
        return "[" + std::to_string(i) + "]" + *place;
      }
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
