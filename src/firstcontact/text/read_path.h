/// @file
/// Finds the files that a scene names.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Where the paths of a scene begin.
struct SceneFolders {
  std::filesystem::path scene;                            ///< Relative paths begin here...
  std::vector<std::filesystem::path> others = {};         ///< ...or in the first that has the file.
  std::vector<std::filesystem::path> package_roots = {};  ///< As opened. For "package://name/...".
};

/// An array of folders, as they are to be opened.
///
/// @param folders  where relative paths begin
[[nodiscard]] std::vector<std::filesystem::path> read_package_roots(const JsonValue& value,
                                                                    const SceneFolders& folders,
                                                                    const JsonReader& read);

/// The path of a file that must exist, as it is to be opened.
///
/// @param what  "a mesh file"
/// @throws ParseError
[[nodiscard]] std::filesystem::path read_path(const JsonValue& value, const std::string& what,
                                              const SceneFolders& folders, const JsonReader& read);

}  // namespace firstcontact::detail
