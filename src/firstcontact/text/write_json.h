/// @file
/// Writes JSON: numbers that read back to the same double, strings that are one line of UTF-8.

#pragma once

#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Writes a tree as JSON on one line.
///
/// @param tree  its numbers are finite: JSON has no others
[[nodiscard]] FIRSTCONTACT_API std::string write_json(const JsonValue& tree);

/// The shortest decimal that reads back to the same double, whatever the locale.
[[nodiscard]] FIRSTCONTACT_API std::string write_json(double number);

/// A string in double quotes with the escapes of JSON. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] FIRSTCONTACT_API std::string write_json(std::string_view text);

/// Writes a string likewise for a message: cut short where it is long.
[[nodiscard]] FIRSTCONTACT_API std::string in_quotes(std::string_view text);

}  // namespace firstcontact::detail
