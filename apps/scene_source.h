/// @file
/// The sources of the scenes of a command line: files, or the lines of JSON Lines files.

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// One scene that is not read yet.
struct SceneSource {
  std::string file;
  std::optional<std::size_t> line;  ///< Line in a file of JSON Lines.
  std::function<Scene()> read;      ///< Throws ParseError; valid during the visit only.
};

/// Whether a file has one scene in each line, by the ending of its name: .jsonl or .ndjson.
[[nodiscard]] bool is_json_lines(const std::filesystem::path& file);

/// Visits the scenes of a file in order until a visit returns false; skips blank lines.
///
/// Standard input, "-", has one scene, or one in each line where the first line is a whole scene.
///
/// @param reading  options of reading the scenes
void for_each_scene(const std::filesystem::path& file, const ReadingOptions& reading,
                    const std::function<bool(const SceneSource&)>& visit);

}  // namespace firstcontact::app
