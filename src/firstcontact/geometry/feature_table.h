/// @file
/// The features of a mesh of few triangles, each once.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

class Shape;

/// The features of a mesh of few triangles, each once and with a number.
///
/// Vertices come first, then edges, then faces, each in the order of the mesh. Vertices and
/// triangles are those of the hierarchy. A triangle owns the features that no triangle before it
/// has (Shape::own_features()).
struct FeatureTable {
  /// The greatest number of triangles of a mesh that has a table.
  static constexpr std::size_t kMostTriangles = 16;
  /// The greatest number of vertices, and of edges; a mesh of degenerate triangles may own as many.
  static constexpr std::size_t kMost = 3 * kMostTriangles;
  /// The greatest number of features.
  static constexpr std::size_t kMostNumbers = 2 * kMost + kMostTriangles;

  /// Corner k of a triangle that owns it.
  struct Corner {
    std::uint8_t triangle = 0;
    std::uint8_t k = 0;
    std::uint8_t vertex = 0;
    std::uint8_t number = 0;
  };

  /// The edge from corner k of a triangle that owns it.
  struct Edge {
    std::uint8_t triangle = 0;
    std::uint8_t k = 0;
    std::array<std::uint8_t, 2> vertices{};  ///< Vertices at which it begins and ends.
    std::array<std::uint8_t, 2> ends{};      ///< Numbers of these vertices.
    std::uint8_t number = 0;                 ///< For an edge without length, that of its vertex.
  };

  /// A triangle.
  struct Face {
    std::array<std::uint8_t, 3> vertices{};
    std::uint8_t number = 0;
  };

  std::vector<Corner> corners;  ///< Sorted by triangles and k.
  std::vector<Edge> edges;      ///< Sorted by triangles and k.
  std::vector<Face> faces;      ///< One for each triangle.

  /// The index in the mesh of each vertex, edge and face, by its number.
  std::vector<std::uint32_t> index;
  std::size_t first_edge = 0;  ///< Number of the first edge.
  std::size_t first_face = 0;  ///< Number of the first face.
  bool has_needles = false;    ///< Whether corners of some triangle are on one line.
};

/// Makes the feature table of a shape.
///
/// @param shape  has at most kMostTriangles triangles
[[nodiscard]] FIRSTCONTACT_API FeatureTable feature_table(const Shape& shape);

}  // namespace firstcontact
