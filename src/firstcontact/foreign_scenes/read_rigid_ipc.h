/// @file
/// Reads the scenes of Rigid IPC, a simulator of rigid bodies, as scenes of ours.

#pragma once

#include <filesystem>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// Reads a fixture of Rigid IPC, JSON with "rigid_body_problem", as a scene.
///
/// The format is that of Z. Ferguson et al., "Intersection-free rigid body dynamics", ACM TOG
/// 40(4), 2021. docs/rigid_ipc.md states the use of each of its keys.
///
/// Bodies are named by their mesh, "cube", or "cube-3" by their number in the file where a mesh
/// occurs more than once. Bodies that do not move freely do not touch each other, nor do bodies of
/// one group. A mesh is looked for beside the file, then in the folders `meshes` of the folders
/// above it. Keys that begin with '#' are comments; other unknown keys become warnings of the
/// scene.
///
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API Scene read_rigid_ipc(const std::filesystem::path& path);

/// Parses the text of such a fixture, as read_rigid_ipc() reads it.
///
/// @param source  names the text in errors; meshes are looked for from its folder on
[[nodiscard]] FIRSTCONTACT_API Scene parse_rigid_ipc(std::string_view text,
                                                     const std::filesystem::path& source);

}  // namespace firstcontact
