/// @file
/// The place of a mesh that a URDF names.

#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace firstcontact::detail {

/// Resolves `package://NAME/rest`, or `file://path` or a path, relative to the URDF's folder.
///
/// The search for a package begins in the roots. Then come those packages of its name that hold the
/// URDF, then the folder of the URDF and all above. The first place that has the file counts. Where
/// none has it, the first that has the package counts.
///
/// @param urdf  the file that names the mesh
/// @throws std::invalid_argument  where no root holds the package
[[nodiscard]] std::filesystem::path resolve_mesh(const std::string& uri,
                                                 const std::filesystem::path& urdf,
                                                 std::span<const std::filesystem::path> roots);

}  // namespace firstcontact::detail
