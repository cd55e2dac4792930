/// @file
/// The tree of a JSON or YAML text, by the extension of its file.

#pragma once

#include <filesystem>
#include <string_view>

#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Whether an extension, as file_extension() has it, is one of JSON or YAML.
[[nodiscard]] bool is_tree_extension(std::string_view extension);

/// Parses a text as JSON where the extension is .json, else as YAML.
///
/// @throws ParseError
[[nodiscard]] JsonValue parse_tree(std::string_view text, const std::filesystem::path& source);

}  // namespace firstcontact::detail
