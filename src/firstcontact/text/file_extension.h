/// @file
/// The ending of a file's name.

#pragma once

#include <filesystem>
#include <string>

#include <firstcontact/text/ascii.h>

namespace firstcontact::detail {

/// The extension of a file in lower case, without the point.
inline std::string file_extension(const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  return extension.empty() ? extension : extension.substr(1);
}

}  // namespace firstcontact::detail
