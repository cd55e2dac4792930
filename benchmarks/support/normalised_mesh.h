/// @file
/// Meshes of one size, so that motions and times are comparable.

#pragma once

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::benchmarks {

/// Scales the mesh to bounding radius 1 m, with the centre of its bounding box at the origin.
[[nodiscard]] Mesh normalised(Mesh mesh);

/// Reads the Stanford bunny (69,451 triangles) of the repository's data, normalised.
[[nodiscard]] Mesh bunny();

}  // namespace firstcontact::benchmarks
