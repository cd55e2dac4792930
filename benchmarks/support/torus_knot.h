/// @file
/// Closed meshes of any size and the same shape: tubes along a torus knot.

#pragma once

#include <cstddef>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::benchmarks {

/// A tube of radius 0.4 m along the (2, 3) torus knot of radii 2 m and 1 m; closed, its triangles
/// nearly alike.
///
/// @param triangles  about as many; at least 200
[[nodiscard]] Mesh torus_knot(std::size_t triangles);

}  // namespace firstcontact::benchmarks
