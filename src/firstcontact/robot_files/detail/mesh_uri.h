/// @file
/// Where the mesh is that a URDF names.

#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace firstcontact::detail {

/// Resolves `package://NAME/rest`, or `file://path` or a path, relative to the URDF's folder.
///
/// A package is looked for in the roots, then in those packages of its name that hold the URDF,
/// then in the folder of the URDF and all above. The first place that has the file counts; where
/// none has it, the first that has the package.
///
/// @param urdf  the file that names it
/// @throws std::invalid_argument  where no root holds the package
[[nodiscard]] std::filesystem::path resolve_mesh(const std::string& uri,
                                                 const std::filesystem::path& urdf,
                                                 std::span<const std::filesystem::path> roots);

}  // namespace firstcontact::detail
