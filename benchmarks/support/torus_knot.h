/// @file
/// Closed meshes of any size and the same shape: tubes along a torus knot.

#pragma once

#include <cstddef>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::benchmarks {

/// Makes a tube of radius 0.4 m along the (2, 3) torus knot of radii 2 m and 1 m; closed, with
/// nearly equal triangles.
///
/// @param triangles  approximate number of triangles; at least 200
[[nodiscard]] Mesh torus_knot(std::size_t triangles);

}  // namespace firstcontact::benchmarks
