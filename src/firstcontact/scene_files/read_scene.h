/// @file
/// Reads the scene file that a user writes (JSON, "firstcontact": 1; see schema/scene.json).

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Reads a scene file.
///
/// Paths in it are relative to its folder. Mesh files must exist, but are not opened yet.
///
/// The reader is strict: an unknown key, a repeated key, a wrong type or a number outside its range
/// is an error. So no typing error silently changes the meaning. A pose's `rpy`, `rotation_vector`
/// and `matrix` are converted to a quaternion in double precision. The certificate holds for the
/// motion that the converted numbers define. The result states these as its resolved scene. The
/// locale changes nothing.
///
/// Where the options are lenient, the scene's own become lenient, and so its files are read.
///
/// @throws ParseError  one line: "path:line: bodies[2].motion.from: what was expected"
[[nodiscard]] FIRSTCONTACT_API Scene read_scene(const std::filesystem::path& path,
                                                const ReadingOptions& options = {});

/// Reads a scene from text.
///
/// @param text        one JSON object
/// @param source      the file of the text: named in errors; relative paths begin in its folder
/// @param first_line  the line of the file on which the text begins
/// @throws ParseError  as read_scene
[[nodiscard]] FIRSTCONTACT_API Scene parse_scene(std::string_view text,
                                                 const std::filesystem::path& source,
                                                 std::size_t first_line = 1,
                                                 const ReadingOptions& options = {});

/// Reads the scene under the key "scene" of a JSON object, as results and runs embed it.
///
/// Its paths are as they were opened, not relative to the object's file. A missing file is looked
/// for from the folder of the object's file, then from each folder above. So a run can be read
/// anywhere.
///
/// @param text  one JSON object; its other keys may be anything
/// @param name  the file of the text
/// @throws ParseError  as read_scene, or if there is no scene
[[nodiscard]] FIRSTCONTACT_API Scene parse_embedded_scene(std::string_view text,
                                                          const std::string& name,
                                                          std::size_t first_line = 1,
                                                          const ReadingOptions& options = {});

}  // namespace firstcontact
