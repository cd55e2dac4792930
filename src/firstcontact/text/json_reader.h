/// @file
/// Reads values of a JSON tree, or reports the place of an unexpected value.

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
  std::vector<std::string_view> later = {};  ///< Keys of the format that this version does not read
                                             ///< yet.
};

/// Reads the values of one tree.
///
/// Every function throws ParseError, "path:line: place: what was expected", where a value is not of
/// the kind that the function names.
class JsonReader {
 public:
  /// @param root    outlives the reader; all values are inside of it
  /// @param source  names the text in errors; outlives the reader
  JsonReader(const JsonValue& root, const std::string& source) : root_(root), source_(source) {}

  [[noreturn]] void fail(const JsonValue& where, const std::string& message) const;

  /// Throws as fail() does, with "expected `what`, got ...".
  [[noreturn]] void fail_expected(const std::string& what, const JsonValue& got) const;

  /// Reads an object that has only known keys.
  [[nodiscard]] const JsonObject& object(const JsonValue& value, const KnownKeys& known) const;

  /// The value of a required key in a value that has to be an object.
  [[nodiscard]] const JsonValue& member(const JsonValue& object, std::string_view key) const;

  [[nodiscard]] const JsonArray& array(const JsonValue& value, const std::string& what) const;
  [[nodiscard]] const std::string& string(const JsonValue& value, const std::string& what) const;

  [[nodiscard]] bool boolean(const JsonValue& value) const;
  [[nodiscard]] double number(const JsonValue& value) const;
  [[nodiscard]] double positive(const JsonValue& value) const;
  [[nodiscard]] double not_negative(const JsonValue& value) const;

  /// Reads an integer in [0, count).
  [[nodiscard]] std::size_t index(const JsonValue& value, std::size_t count,
                                  const std::string& what) const;

  /// Reads three numbers of at most 1e60 in size, beyond which products of lengths would overflow.
  [[nodiscard]] Eigen::Vector3d vector3(const JsonValue& value) const;

  /// The index of the word that a string is.
  [[nodiscard]] std::size_t word(const JsonValue& value, const KnownKeys& known) const;

  /// The enumerator whose word a string is.
  ///
  /// @param words  words of the enumerators, in their order
  template <class Enum, class Words>
  [[nodiscard]] Enum enumerator(const JsonValue& value, const Words& words) const {
    return static_cast<Enum>(word(value, {{words.begin(), words.end()}}));
  }

 private:
  const JsonValue& root_;
  const std::string& source_;
};

/// The word that needs the fewest changes of a letter, or that begins with this one; empty if all
/// are far off.
[[nodiscard]] FIRSTCONTACT_API std::string_view nearest_word(
    std::string_view word, const std::vector<std::string_view>& words);

/// Lists words: "a, b, c"; "none" for no words.
[[nodiscard]] std::string listed(const std::vector<std::string_view>& words);

}  // namespace firstcontact::detail
