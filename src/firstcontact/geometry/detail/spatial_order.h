/// @file
/// Puts what is near in space near in memory.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// The used vertices and the triangles of a mesh along a space-filling curve.
struct SpatialOrder {
  Mesh mesh;
  std::vector<std::uint32_t> vertex_index;    ///< Of each vertex, in the mesh as it was.
  std::vector<std::uint32_t> triangle_index;  ///< Of each triangle.
};

/// By the Morton codes of the first corners, ties by index: the same on every run.
///
/// @param mesh  not empty, finite, indices in range
SpatialOrder spatial_order(const Mesh& mesh);

}  // namespace firstcontact::detail
