/// @file
/// Parses YAML into the tree that JSON gives, so that one reader serves both.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Most values that aliases and anchors repeat, beyond those that stand in the text.
inline constexpr std::size_t kMaximumRepeatedYamlValues = 1'000'000;

/// Parses the one YAML document of a text that has contents, whatever the locale.
///
/// The text is UTF-8. Keys are words and not repeated, and at most kMaximumJsonDepth containers are
/// inside each other. Empty documents before and after it, as `rostopic echo` prints them, are
/// passed over.
///
/// Plain scalars are those of JSON: null (and ~), true and false (as in YAML 1.2; also with a
/// capital), decimal numbers that fit a double. All other scalars, those in quotes, `.nan` and
/// `.inf` are strings. A number after `!degrees` is converted to radians, one after `!radians` is as
/// it stands. Other tags than those of YAML's core are refused.
///
/// @param source  names the text in errors
/// @throws ParseError  with the line and what was expected there
[[nodiscard]] FIRSTCONTACT_API JsonValue parse_yaml(std::string_view text,
                                                    const std::string& source);

}  // namespace firstcontact::detail
