/// @file
/// The whole of a text file.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// @throws ParseError if it cannot be read
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

}  // namespace firstcontact::detail
