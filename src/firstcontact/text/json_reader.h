/// @file
/// Takes values out of a JSON tree, or reports the place that holds something else than expected.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// The keys that an object may hold.
struct KnownKeys {
  std::vector<std::string_view> keys;
  std::vector<std::string_view> later = {};  ///< In the format, but not in this version yet.
};

/// Reads the values of one tree. Every function throws ParseError, "path:line: place: what was
/// expected", where a value is not of the kind that the function names.
class JsonReader {
 public:
  /// @param root    outlives the reader; all values are inside of it
  /// @param source  names the text in errors; outlives the reader
  JsonReader(const JsonValue& root, const std::string& source) : root_(root), source_(source) {}

  [[noreturn]] void fail(const JsonValue& where, const std::string& message) const;

  /// fail() with "expected `what`, got ...".
  [[noreturn]] void fail_expected(const std::string& what, const JsonValue& got) const;

  /// An object without other keys than the known ones.
  [[nodiscard]] const JsonObject& object(const JsonValue& value, const KnownKeys& known) const;

  /// The value of a key that must be there, in what must be an object.
  [[nodiscard]] const JsonValue& member(const JsonValue& object, std::string_view key) const;

  [[nodiscard]] const JsonArray& array(const JsonValue& value, const std::string& what) const;
  [[nodiscard]] const std::string& string(const JsonValue& value, const std::string& what) const;

  [[nodiscard]] bool boolean(const JsonValue& value) const;
  [[nodiscard]] double number(const JsonValue& value) const;
  [[nodiscard]] double positive(const JsonValue& value) const;
  [[nodiscard]] double not_negative(const JsonValue& value) const;

  /// An integer in [0, count).
  [[nodiscard]] std::size_t index(const JsonValue& value, std::size_t count,
                                  const std::string& what) const;

  /// Three numbers of at most 1e60 in size, beyond which products of lengths would overflow.
  [[nodiscard]] Eigen::Vector3d vector3(const JsonValue& value) const;

  /// Which of the words a string is.
  [[nodiscard]] std::size_t word(const JsonValue& value, const KnownKeys& known) const;

  /// The enumerator whose word a string is.
  ///
  /// @param words  of the enumerators, in their order
  template <class Enum, class Words>
  [[nodiscard]] Enum enumerator(const JsonValue& value, const Words& words) const {
    return static_cast<Enum>(word(value, {{words.begin(), words.end()}}));
  }

 private:
  const JsonValue& root_;
  const std::string& source_;
};

/// The word that takes the fewest changes of a letter to get to, or that begins with this one;
/// empty if all are far off.
[[nodiscard]] FIRSTCONTACT_API std::string_view nearest_word(
    std::string_view word, const std::vector<std::string_view>& words);

/// "a, b, c"; "none" of no words.
[[nodiscard]] std::string listed(const std::vector<std::string_view>& words);

}  // namespace firstcontact::detail
