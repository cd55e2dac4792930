/// @file
/// The unusual features of a mesh; none of them keeps a query from being right.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Counts of defects. Vertices count as they are numbered: weld first.
///
/// A triangle with repeated corners bounds no surface: it is not counted among doubled ones,
/// nor are its edges.
struct MeshDefects {
  std::size_t edges = 0;                 ///< Unique ones.
  std::size_t open_edges = 0;            ///< Of one triangle.
  std::size_t nonmanifold_edges = 0;     ///< Of three triangles or more.
  std::size_t degenerate_triangles = 0;  ///< Equal corners, or area <= 1e-12 (longest edge)^2.
  std::size_t doubled_triangles = 0;     ///< With the corners of an earlier one, in any order.
  std::size_t nonfinite_vertices = 0;
  std::size_t unused_vertices = 0;
  std::size_t components = 0;  ///< Sets of triangles joined by shared vertices.
  bool closed = false;         ///< Every edge has exactly two triangles, and there are edges.
  bool consistently_oriented = false;  ///< Two triangles run their edge in opposite directions.
  Eigen::AlignedBox3d bounds;          ///< [m]  Of the finite vertices that triangles use.

  /// [m^3]  By rounded sums; only of a closed, consistently oriented, finite mesh.
  /// Positive where the triangles face outwards.
  std::optional<double> signed_volume;
};

/// Inspects a mesh; takes about a second per million triangles at most.
///
/// @param mesh  may be empty or hold vertices that are not finite; indices must be in range
/// @throws std::invalid_argument if an index is out of range
[[nodiscard]] FIRSTCONTACT_API MeshDefects inspect(const Mesh& mesh);

/// The reason why a mesh encloses no space, as "12 open edges"; empty if it encloses some.
///
/// A mesh encloses none where it is not closed, or its triangles do not agree on their inner side.
///
/// @throws std::invalid_argument if an index is out of range
[[nodiscard]] FIRSTCONTACT_API std::string why_not_solid(const Mesh& mesh);

}  // namespace firstcontact
