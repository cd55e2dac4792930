/// @file
/// The unusual features of a mesh. With each of them queries are still right.

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
/// A triangle with repeated corners bounds no surface. It is not counted among doubled triangles,
/// and its edges are not counted.
struct MeshDefects {
  std::size_t edges = 0;                 ///< Unique edges.
  std::size_t open_edges = 0;            ///< Edges of one triangle.
  std::size_t nonmanifold_edges = 0;     ///< Edges of three triangles or more.
  std::size_t degenerate_triangles = 0;  ///< Equal corners, or area <= 1e-12 (longest edge)^2.
  /// Triangles with the corners of an earlier one, in any order.
  std::size_t doubled_triangles = 0;
  std::size_t nonfinite_vertices = 0;
  std::size_t unused_vertices = 0;
  std::size_t components = 0;  ///< Sets of triangles joined by shared vertices.
  bool closed = false;         ///< Every edge has exactly two triangles, and there are edges.
  /// Whether two triangles run their common edge in opposite directions.
  bool consistently_oriented = false;
  Eigen::AlignedBox3d bounds;  ///< [m]  Box around the finite vertices that triangles use.

  /// [m^3]  Volume by rounded sums, for a closed, consistently oriented, finite mesh only. Positive
  /// where the triangles face outwards.
  std::optional<double> signed_volume;
};

/// Inspects a mesh; takes about a second per million triangles at most.
///
/// @param mesh  may be empty or hold vertices that are not finite; indices must be in range
/// @throws std::invalid_argument if an index is out of range
[[nodiscard]] FIRSTCONTACT_API MeshDefects inspect(const Mesh& mesh);

/// Finds the reason why a mesh encloses no space, as "12 open edges"; empty if it encloses some.
///
/// A mesh encloses no space where it is not closed, or where its triangles do not agree on their
/// inner side.
///
/// @throws std::invalid_argument if an index is out of range
[[nodiscard]] FIRSTCONTACT_API std::string why_not_solid(const Mesh& mesh);

}  // namespace firstcontact
