/// @file
/// Parses YAML into the tree that JSON gives, so that one reader serves both.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Beyond what stands in the text itself, its aliases and anchors repeat no more values.
inline constexpr std::size_t kMaximumRepeatedYamlValues = 1'000'000;

/// Parses the one YAML document of a text that holds something, whatever the locale. UTF-8, keys
/// are words and not repeated, at most kMaximumJsonDepth containers deep; empty documents before
/// and after it, as `rostopic echo` prints them, are passed over.
///
/// Plain scalars are what JSON knows: null (and ~), true and false (as in YAML 1.2; also with a
/// capital), decimal numbers that fit a double. All other scalars, those in quotes, `.nan` and
/// `.inf` are strings.
///
/// @param source  names the text in errors
/// @throws ParseError  with the line and what was expected there
[[nodiscard]] FIRSTCONTACT_API JsonValue parse_yaml(std::string_view text,
                                                    const std::string& source);

}  // namespace firstcontact::detail
