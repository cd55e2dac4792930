/// @file
/// Parses YAML into the tree that JSON gives, so that one reader serves both.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// No tree of a text is larger, whatever its aliases repeat.
inline constexpr std::size_t kMaximumYamlValues = 20'000'000;

/// Parses one YAML document that fills the text, whatever the locale. UTF-8, keys are words and not
/// repeated, at most kMaximumJsonDepth containers deep; an empty document after the first, as
/// `rostopic echo` prints one, is passed over.
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
