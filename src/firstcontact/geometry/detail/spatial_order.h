/// @file
/// An order of a mesh in memory that keeps neighbours in space together.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// The used vertices and the triangles of a mesh along a space-filling curve.
struct SpatialOrder {
  Mesh mesh;
  std::vector<std::uint32_t> vertex_index;    ///< Index of each vertex in the mesh as it was.
  std::vector<std::uint32_t> triangle_index;  ///< Index of each triangle in the mesh as it was.
};

/// Sorts a mesh by the Morton codes of the first corners, ties by index: the same on every run.
///
/// @param mesh  not empty, finite, indices in range
SpatialOrder spatial_order(const Mesh& mesh);

}  // namespace firstcontact::detail
