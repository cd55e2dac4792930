/// @file
/// The formats that the assimp library reads for us.

#pragma once

#include <string>
#include <string_view>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// Reads a dae, glb or gltf file; `bytes` are the same file's. Not welded.
///
/// @throws ParseError
Mesh read_with_assimp(const std::string& path, std::string_view bytes, std::string_view extension);

}  // namespace firstcontact::detail
