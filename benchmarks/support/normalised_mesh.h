/// @file
/// Meshes of one size, so that motions and times compare.

#pragma once

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::benchmarks {

/// The mesh scaled to bounding radius 1 m, with the centre of its bounding box at the origin.
[[nodiscard]] Mesh normalised(Mesh mesh);

/// The Stanford bunny (69,451 triangles) of the repository's data, normalised.
[[nodiscard]] Mesh bunny();

}  // namespace firstcontact::benchmarks
