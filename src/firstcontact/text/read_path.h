/// @file
/// Finds the files that a scene names.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// The folders in which the paths of a scene begin.
struct SceneFolders {
  std::filesystem::path scene;                     ///< Folder of relative paths.
  std::vector<std::filesystem::path> others = {};  ///< Further folders; the first that has the file
                                                   ///< counts.
  std::vector<std::filesystem::path> package_roots = {};  ///< As opened; for "package://name/...".
};

/// The folders for a text that may have been moved with its files: the current folder, then that of
/// the file and all above it.
[[nodiscard]] SceneFolders folders_around(const std::filesystem::path& file);

/// The path of a file by its name: from the scene's folder, or from the first other folder that has
/// it. Where none has it, it is that from the scene's folder.
[[nodiscard]] std::filesystem::path found_file(const std::string& name,
                                               const SceneFolders& folders);

/// Reads an array of folders, as they are to be opened.
///
/// @param folders  folders in which relative paths begin
[[nodiscard]] std::vector<std::filesystem::path> read_package_roots(const JsonValue& value,
                                                                    const SceneFolders& folders,
                                                                    const JsonReader& read);

/// Reads the path of a file that must exist, as it is to be opened.
///
/// @param what  "a mesh file"
/// @throws ParseError
[[nodiscard]] std::filesystem::path read_path(const JsonValue& value, const std::string& what,
                                              const SceneFolders& folders, const JsonReader& read);

}  // namespace firstcontact::detail
