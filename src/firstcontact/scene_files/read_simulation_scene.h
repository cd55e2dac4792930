/// @file
/// Reads a scene to simulate: one of ours, or one of Rigid IPC.

#pragma once

#include <filesystem>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Reads a scene to simulate, of either format: read_rigid_ipc where the file has a key
/// "rigid_body_problem", else read_scene.
///
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API Scene read_simulation_scene(const std::filesystem::path& path,
                                                           const ReadingOptions& options = {});

/// Parses the text of a scene to simulate, as read_simulation_scene() reads it.
///
/// @param source  names the text in errors; files are looked for from its folder on
[[nodiscard]] FIRSTCONTACT_API Scene parse_simulation_scene(std::string_view text,
                                                            const std::filesystem::path& source,
                                                            const ReadingOptions& options = {});

}  // namespace firstcontact
