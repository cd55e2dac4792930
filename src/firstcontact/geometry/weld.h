/// @file
/// Merges vertices at the same place.

#pragma once

#include <cstddef>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Merges vertices whose coordinates are equal to the last bit (-0.0 equals 0.0) into the first of
/// them, and renumbers the triangles. No other vertex moves, whatever the distance.
///
/// The order of vertices stays, unused ones stay too: where no position occurs twice, every vertex
/// keeps its number. Triangles keep order and corners; no triangle is dropped.
///
/// @param mesh  indices in range
/// @returns     how many vertices were merged away
FIRSTCONTACT_API std::size_t weld(Mesh& mesh);

}  // namespace firstcontact
