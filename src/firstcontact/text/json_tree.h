/// @file
/// JSON as a tree. Values have a line and a place in the tree, so that errors name both.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact::detail {

struct JsonValue;
struct JsonMember;
struct JsonNull {};
using JsonArray = std::vector<JsonValue>;
using JsonObject = std::vector<JsonMember>;  // In the order of the text.

/// JSON that is written already, as a tree of a long text takes ten times the memory.
///
/// No reader makes one.
struct JsonText {
  std::string text;
};

using JsonVariant =
    std::variant<JsonNull, bool, double, std::string, JsonArray, JsonObject, JsonText>;

struct JsonValue {
  JsonVariant value;
  std::size_t line = 0;  ///< Line on which it begins; 0 if it was not read from a text.
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

/// The value of a key; null if the object has none.
[[nodiscard]] FIRSTCONTACT_API const JsonValue* find(const JsonObject& object,
                                                     std::string_view key);

/// The place of a value below the root: "bodies[2].motion"; empty for the root itself.
///
/// It searches the tree, so that no places have to be kept before there is an error.
///
/// @param value  the very object in the tree, not a copy
[[nodiscard]] FIRSTCONTACT_API std::string place_of(const JsonValue& value, const JsonValue& root);

}  // namespace firstcontact::detail
