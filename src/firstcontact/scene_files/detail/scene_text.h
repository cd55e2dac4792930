/// @file
/// The text of a scene file.

#pragma once

#include <filesystem>
#include <string>

namespace firstcontact::detail {

/// Reads the text of a scene file.
///
/// A file whose ending is that of a mesh, a cloud, a robot or a trajectory is refused, with the use
/// that it has instead.
///
/// @throws ParseError
[[nodiscard]] std::string scene_text(const std::filesystem::path& path);

}  // namespace firstcontact::detail
