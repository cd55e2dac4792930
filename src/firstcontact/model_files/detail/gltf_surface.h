/// @file
/// The triangles of a glTF document, placed in the world.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/model_files/detail/gltf_mesh.h>
#include <firstcontact/model_files/detail/gltf_skin.h>

namespace firstcontact::detail {

/// The placement of a primitive in the world.
struct GltfPlacement {
  /// Map from the mesh's frame; not used with a skin.
  Eigen::Affine3d X_WM = Eigen::Affine3d::Identity();
  const GltfSkin* skin = nullptr;    ///< Moves the vertices where there is one.
  std::vector<double> weights = {};  ///< Weights of the morph targets; empty: all zero.
};

/// Collects placed primitives. Vertices that no triangle uses are dropped, as primitives often
/// share one large array of them. The others keep the order of the array.
class GltfSurface {
 public:
  explicit GltfSurface(const GltfDocument& document) : document_(document) {}

  void reserve(std::size_t vertices, std::size_t triangles);

  /// Adds a primitive: first its morph targets act, then its skin or its map. Triangles are turned
  /// where the map mirrors, so that the inside of a closed surface stays inside.
  ///
  /// @throws ParseError  an index without a vertex, an index that restarts a strip, a coordinate
  ///         that is not finite, 2^32 vertices or more, and as blend()
  void add(const GltfPrimitive& primitive, const GltfPlacement& placement);

  [[nodiscard]] Mesh finish();

 private:
  void select(const GltfPrimitive& primitive);
  void select_indexed(const GltfPrimitive& primitive);
  [[nodiscard]] std::size_t index(const GltfPrimitive& primitive, std::size_t corner) const;
  [[nodiscard]] bool add_vertices(const GltfPrimitive& primitive, const GltfPlacement& placement);

  const GltfDocument& document_;
  Mesh mesh_;
  std::vector<std::uint32_t> used_;  ///< The used vertices of the current primitive, ascending.
  /// Index in the mesh of each of its vertices; kNone for the rest.
  std::vector<std::uint32_t> number_;
};

}  // namespace firstcontact::detail
