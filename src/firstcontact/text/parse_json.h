/// @file
/// Parses strict JSON (RFC 8259).

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

inline constexpr std::size_t kMaximumJsonDepth = 64;

/// Parses one JSON value that fills the text, whatever the locale.
///
/// The parser is strict: UTF-8, no comments, no repeated keys, numbers that fit a double, at most
/// kMaximumJsonDepth containers deep.
///
/// @param source      names the text in errors
/// @param first_line  the line of the source on which the text begins
/// @throws ParseError  with the line and what was expected there
[[nodiscard]] FIRSTCONTACT_API JsonValue parse_json(std::string_view text,
                                                    const std::string& source,
                                                    std::size_t first_line = 1);

}  // namespace firstcontact::detail
