/// @file
/// Meshes of a glTF document: their primitives, and the arrays of these.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/model_files/detail/gltf_accessor.h>

namespace firstcontact::detail {

/// The ways in which corners make triangles.
enum class GltfMode { triangles, strip, fan };

/// The joints of a skin that move vertices, with their weights: four a vertex.
struct GltfInfluences {
  GltfAccessor joints;
  GltfAccessor weights;
};

/// A primitive of triangles.
struct GltfPrimitive {
  const JsonValue* where = nullptr;  ///< Its place in the document, for errors.
  GltfMode mode = GltfMode::triangles;
  GltfAccessor positions;
  std::optional<GltfAccessor> indices = {};
  /// Displacements of the positions by each morph target.
  std::vector<std::optional<GltfAccessor>> targets = {};
  std::vector<GltfInfluences> influences = {};

  /// Counts the corners that make triangles. Without indices that is the number of vertices.
  [[nodiscard]] std::size_t corner_count() const {
    return indices ? indices->count() : positions.count();
  }
  [[nodiscard]] std::size_t triangle_count() const;

  /// Finds the corners of triangle i. Every second triangle of a strip is turned, so that all of
  /// them are seen from the same side.
  [[nodiscard]] std::array<std::size_t, 3> corners(std::size_t i) const;
};

/// The primitives of a mesh, and its weights.
struct GltfMesh {
  std::vector<GltfPrimitive> primitives;  ///< The primitives of triangles.
  std::vector<double> weights;  ///< Weights of the morph targets; empty if the mesh has none.
};

/// Reads the weights of a mesh or of a node.
[[nodiscard]] std::vector<double> read_weights(const GltfDocument& document,
                                               const JsonObject& object);

/// Reads a mesh. Points, lines and attributes of the looks are left out by name.
///
/// @throws ParseError  a mode that glTF does not have, arrays of different lengths, a number of
///         corners that is no multiple of three, compressed geometry; and as GltfAccessorReader
[[nodiscard]] GltfMesh read_gltf_mesh(const GltfDocument& document,
                                      const GltfAccessorReader& accessors, std::size_t index);

}  // namespace firstcontact::detail
