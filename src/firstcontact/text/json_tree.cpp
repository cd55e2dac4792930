#include <firstcontact/text/json_tree.h>

#include <algorithm>
#include <optional>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

bool is_word(std::string_view key) {
  const auto is_word_character = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !key.empty() && key.size() <= 60 && std::all_of(key.begin(), key.end(), is_word_character);
}

std::string in_brackets(std::string_view inside) {
  std::string text = "[";
  text += inside;
  text += ']';
  return text;
}

/// Joins places. `rest` follows a dot, unless it is an element of an array.
std::string join(const std::string& place, const std::string& rest) {
  return place + (rest.empty() || rest.front() == '[' ? "" : ".") + rest;
}

std::optional<std::string> search(const JsonValue& value, const JsonValue& below) {
  if (&value == &below) {
    return "";
  }
  if (const auto* array = std::get_if<JsonArray>(&below.value)) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (const auto rest = search(value, (*array)[i])) {
        return join(in_brackets(std::to_string(i)), *rest);
      }
    }
  }
  if (const auto* object = std::get_if<JsonObject>(&below.value)) {
    for (const auto& [key, member] : *object) {
      if (const auto rest = search(value, member)) {
        return join(is_word(key) ? key : in_brackets(in_quotes(key)), *rest);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

const JsonValue* find(const JsonObject& object, std::string_view key) {
  const auto found = std::find_if(object.begin(), object.end(),
                                  [&](const JsonMember& member) { return member.key == key; });
  return found == object.end() ? nullptr : &found->value;
}

std::string place_of(const JsonValue& value, const JsonValue& root) {
  return search(value, root).value_or("");
}

}  // namespace firstcontact::detail
