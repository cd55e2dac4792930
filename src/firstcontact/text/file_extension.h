/// @file
/// The ending of a file's name.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// In lower case, without the point.
inline std::string file_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  return extension.empty() ? extension : extension.substr(1);
}

}  // namespace firstcontact::detail
