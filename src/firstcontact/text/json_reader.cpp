#include <firstcontact/text/json_reader.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include <firstcontact/text/edit_distance.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// A description of the value that was found, for a message.
struct Description {
  std::string operator()(JsonNull) const { return "null"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(double value) const { return write_json(value); }
  std::string operator()(const std::string& value) const { return in_quotes(value); }
  std::string operator()(const JsonArray& value) const {
    return "an array of " + std::to_string(value.size());
  }
  std::string operator()(const JsonObject&) const { return "an object"; }
  std::string operator()(const JsonText&) const { return "JSON"; }
};

/// The distance of a word from a known one; the first half of a known word is near.
std::size_t distance(std::string_view word, std::string_view known) {
  constexpr std::size_t kLongestWord = 60;  // No longer word is near, and the search is quadratic.
  if (word.size() >= 4 && known.starts_with(word)) {
    return 1;
  }
  return word.size() > kLongestWord ? word.size() : edit_distance(word, known);
}

bool holds(const std::vector<std::string_view>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Suggests a known word in place of an unknown one, or lists all.
std::string mend(std::string_view word, const KnownKeys& known) {
  if (holds(known.later, word)) {
    return "this version does not have " + in_quotes(word) + " yet; it has " + listed(known.keys);
  }
  const std::string_view nearest = nearest_word(word, known.keys);
  return nearest.empty() ? "known are " + listed(known.keys)
                         : "did you mean " + in_quotes(nearest) + "?";
}

}  // namespace

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& words) {
  std::string_view nearest;
  std::size_t least = word.size() / 3 + 2;  // More changes than these make another word.
  for (const std::string_view candidate : words) {
    const std::size_t changes = distance(word, candidate);
    if (changes < least && changes < candidate.size()) {
      least = changes;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string listed(const std::vector<std::string_view>& words) {
  if (words.empty()) {
    return "none";
  }
  std::string text;
  for (const std::string_view word : words) {
    text += (text.empty() ? "" : ", ") + in_quotes(word);
  }
  return text;
}

void JsonReader::fail(const JsonValue& where, const std::string& message) const {
  const std::string place = place_of(where, root_);
  throw ParseError(source_, where.line, place.empty() ? message : place + ": " + message);
}

void JsonReader::fail_expected(const std::string& what, const JsonValue& got) const {
  fail(got, "expected " + what + ", got " + std::visit(Description{}, got.value));
}

const JsonObject& JsonReader::object(const JsonValue& value, const KnownKeys& known) const {
  const auto* object = std::get_if<JsonObject>(&value.value);
  if (object == nullptr) {
    fail_expected("an object with " + listed(known.keys), value);
  }
  for (const auto& [key, member] : *object) {
    if (!holds(known.keys, key)) {
      const bool later = holds(known.later, key);
      fail(member, (later ? "" : "unknown key; ") + mend(key, known));
    }
  }
  return *object;
}

const JsonValue& JsonReader::member(const JsonValue& object, std::string_view key) const {
  const auto* members = std::get_if<JsonObject>(&object.value);
  if (members == nullptr) {
    fail_expected("an object with " + in_quotes(key), object);
  }
  const JsonValue* member = find(*members, key);
  if (member == nullptr) {
    fail(object, "expected a key " + in_quotes(key) + ", got none");
  }
  return *member;
}

const JsonArray& JsonReader::array(const JsonValue& value, const std::string& what) const {
  const auto* array = std::get_if<JsonArray>(&value.value);
  if (array == nullptr) {
    fail_expected(what, value);
  }
  return *array;
}

const std::string& JsonReader::string(const JsonValue& value, const std::string& what) const {
  const auto* string = std::get_if<std::string>(&value.value);
  if (string == nullptr || string->empty()) {
    fail_expected(what, value);
  }
  return *string;
}

bool JsonReader::boolean(const JsonValue& value) const {
  const auto* boolean = std::get_if<bool>(&value.value);
  if (boolean == nullptr) {
    fail_expected("true or false", value);
  }
  return *boolean;
}

double JsonReader::number(const JsonValue& value) const {
  const auto* number = std::get_if<double>(&value.value);
  if (number == nullptr) {
    fail_expected("a number", value);
  }
  return *number;
}

double JsonReader::positive(const JsonValue& value) const {
  const double result = number(value);
  if (!(result > 0.0)) {
    fail_expected("a number > 0", value);
  }
  return result;
}

double JsonReader::not_negative(const JsonValue& value) const {
  const double result = number(value);
  if (!(result >= 0.0)) {
    fail_expected("a number >= 0", value);
  }
  return result;
}

std::size_t JsonReader::index(const JsonValue& value, std::size_t count,
                              const std::string& what) const {
  const auto* number = std::get_if<double>(&value.value);
  const bool valid = number != nullptr && *number >= 0.0 && *number < static_cast<double>(count) &&
                     std::trunc(*number) == *number;
  if (!valid) {
    fail_expected(what + ", an integer from 0 to " + std::to_string(count - 1), value);
  }
  return static_cast<std::size_t>(*number);
}

Eigen::Vector3d JsonReader::vector3(const JsonValue& value) const {
  constexpr double kMaximumCoordinate = 1e60;
  const JsonArray& elements = array(value, "three numbers");
  if (elements.size() != 3) {
    fail_expected("three numbers", value);
  }
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) {
    const JsonValue& element = elements[static_cast<std::size_t>(i)];
    result[i] = number(element);
    if (!(std::abs(result[i]) <= kMaximumCoordinate)) {
      fail_expected("a number of at most 1e60 in size", element);
    }
  }
  return result;
}

std::size_t JsonReader::word(const JsonValue& value, const KnownKeys& known) const {
  const std::string& word = string(value, "one of " + listed(known.keys));
  const auto found = std::find(known.keys.begin(), known.keys.end(), word);
  if (found == known.keys.end()) {
    const bool later = holds(known.later, word);
    fail(value, (later ? "" : "unknown word " + in_quotes(word) + "; ") + mend(word, known));
  }
  return static_cast<std::size_t>(found - known.keys.begin());
}

}  // namespace firstcontact::detail
