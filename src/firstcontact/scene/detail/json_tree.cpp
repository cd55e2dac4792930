#include <firstcontact/scene/detail/json_tree.h>

#include <algorithm>
#include <optional>

#include <firstcontact/scene/detail/write_json.h>

namespace firstcontact::detail {
namespace {

bool is_word(std::string_view key) {
  const auto is_word_character = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !key.empty() && key.size() <= 60 && std::all_of(key.begin(), key.end(), is_word_character);
}

std::string member_place(const std::string& key, const std::string& rest) {
  const std::string dot = rest.empty() || rest.front() == '[' ? "" : ".";
  return (is_word(key) ? key : "[" + in_quotes(key) + "]") + dot + rest;
}

std::string element_place(std::size_t index, const std::string& rest) {
  const std::string dot = rest.empty() || rest.front() == '[' ? "" : ".";
  return "[" + std::to_string(index) + "]" + dot + rest;
}

std::optional<std::string> search(const JsonValue& value, const JsonValue& below) {
  if (&value == &below) {
    return "";
  }
  if (const auto* array = std::get_if<JsonArray>(&below.value)) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (const auto rest = search(value, (*array)[i])) {
        return element_place(i, *rest);
      }
    }
  }
  if (const auto* object = std::get_if<JsonObject>(&below.value)) {
    for (const auto& [key, member] : *object) {
      if (const auto rest = search(value, member)) {
        return member_place(key, *rest);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

const JsonValue* find(const JsonObject& object, std::string_view key) {
  const auto found = std::find_if(object.begin(), object.end(),
                                  [&](const auto& member) { return member.first == key; });
  return found == object.end() ? nullptr : &found->second;
}

std::string place_of(const JsonValue& value, const JsonValue& root) {
  return search(value, root).value_or("");
}

}  // namespace firstcontact::detail
