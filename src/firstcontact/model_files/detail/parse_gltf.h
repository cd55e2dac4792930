/// @file
/// Reads glTF 2.0 documents, as text or in a GLB container.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

/// The limits of a document's content.
struct GltfLimits {
  /// The most vertices and triangles that a document may place beyond twice the number of its
  /// bytes.
  ///
  /// A document can place meshes again and again. A vertex counts once for each morph target and
  /// each set of joints, too. Without a limit a small file could fill any memory.
  std::size_t most_placed = std::size_t{1} << 26;
};

/// Reads the triangles of one scene in double precision, in metres. The y axis, which is up in
/// glTF, stays y. Not welded.
///
/// Positions are decoded exactly, normalised integers as the nearest double to their quotient. The
/// maps of nodes, instances and joints are multiplied in double precision, with rounding. A mesh
/// whose map is the identity keeps its bits. Skins take the pose of the nodes, morph targets their
/// default weights. Points and lines are drawings. They are left out by name, as are looks,
/// cameras, lights and animations.
///
/// Source: Khronos Group, "glTF 2.0 Specification", and its extensions KHR_mesh_quantization and
/// EXT_mesh_gpu_instancing.
///
/// @param bytes   of a .gltf or a .glb file; the bytes show which
/// @param source  the path of the file; its buffers are relative to its folder, and are noted in
///                the log
/// @throws ParseError  one line: the file is malformed, requires an unsupported feature, names or
///         holds a missing element, or has no triangle
[[nodiscard]] Mesh parse_gltf(std::string_view bytes, const std::filesystem::path& source,
                              ReadingLog& log, const GltfLimits& limits = {});

}  // namespace firstcontact::detail
