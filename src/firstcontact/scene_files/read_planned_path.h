/// @file
/// Reads a planned path (see docs/path_format.md).

#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

class ShapeCache;
struct LoadedScene;

/// Parses the text of a path file.
///
/// It checks the form: keys, kinds of values, counts that belong together, names that the scene
/// has. Nothing is proven, and no mesh is read. Files of the path are looked for as robots are: in
/// the current folder, then in that of the path and those above it.
///
/// @param source  names the text in errors
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API PlannedPath parse_planned_path(std::string_view text,
                                                              const std::filesystem::path& source,
                                                              const ReadingOptions& options = {});

/// Reads a path file, as parse_planned_path() reads its text.
[[nodiscard]] FIRSTCONTACT_API PlannedPath read_planned_path(const std::filesystem::path& file,
                                                             const ReadingOptions& options = {});

/// Loads the scene of a path, with its meshes and robots.
///
/// @throws std::invalid_argument if a file has changed since the path was planned
/// @throws as load_scene
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene_of(const PlannedPath& path,
                                                         ShapeCache& cache);

/// The files with which a path was planned.
struct PathFiles {
  std::span<const PathSource> sources;
  std::string input_digest;
};

/// Loads the scene of a path, as load_scene_of() does.
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_planned_scene(const Scene& scene,
                                                              const PathFiles& files,
                                                              ShapeCache& cache);

}  // namespace firstcontact
