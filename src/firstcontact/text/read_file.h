/// @file
/// A whole text file as one string.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// Reads all bytes of a file.
/// @param what  the expected kind of file, for the error: "a scene file"
/// @param what  was expected, for the error: "a scene file"
/// @throws ParseError if it cannot be read
[[nodiscard]] std::string read_file(const std::filesystem::path& path, const std::string& what);

}  // namespace firstcontact::detail
