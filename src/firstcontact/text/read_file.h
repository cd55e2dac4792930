/// @file
/// The whole of a text file.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// @param what  was expected, for the error: "a scene file"
/// @throws ParseError if it cannot be read
[[nodiscard]] std::string read_file(const std::filesystem::path& path, const std::string& what);

}  // namespace firstcontact::detail
