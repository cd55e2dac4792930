/// @file
/// Connected components of the vertices of a mesh.

#pragma once

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/disjoint_sets.h>

namespace firstcontact::detail {

/// Finds the sets of vertices that triangles join.
inline DisjointSets vertex_components(const Mesh& mesh) {
  DisjointSets components(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    components.join(t[0], t[1]);
    components.join(t[0], t[2]);
  }
  return components;
}

}  // namespace firstcontact::detail
