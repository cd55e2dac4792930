/// @file
/// Where the mesh is that a URDF names.

#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace firstcontact::detail {

/// Resolves `package://NAME/rest`, `file://path` or a path relative to the URDF's folder.
///
/// @param urdf  the file that names it
/// @throws std::invalid_argument  where no root holds the package
[[nodiscard]] std::filesystem::path resolve_mesh(const std::string& uri,
                                                 const std::filesystem::path& urdf,
                                                 std::span<const std::filesystem::path> roots);

}  // namespace firstcontact::detail
