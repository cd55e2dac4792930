/// @file
/// The text of a scene file.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// Reads the file; one whose ending is of a mesh, a cloud, a robot or a trajectory is refused by
/// what to do with it instead.
///
/// @throws ParseError
[[nodiscard]] std::string scene_text(const std::filesystem::path& path);

}  // namespace firstcontact::detail
