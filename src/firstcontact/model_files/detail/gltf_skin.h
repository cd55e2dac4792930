/// @file
/// Skins of a glTF document in the pose that its nodes have.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/gltf_accessor.h>
#include <firstcontact/model_files/detail/gltf_mesh.h>
#include <firstcontact/model_files/detail/gltf_nodes.h>

namespace firstcontact::detail {

/// A skin: the map that each of its joints applies to bound vertices, from the mesh's frame to the
/// world's.
struct GltfSkin {
  std::vector<Eigen::Affine3d> X_WM;  ///< X_WJ times the inverse bind matrix, for each joint J.
};

/// Reads a skin. Missing inverse bind matrices are identities.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 3.7.3 (skins).
///
/// @param index  of an existing skin
[[nodiscard]] GltfSkin read_gltf_skin(const GltfDocument& document,
                                      const GltfAccessorReader& accessors, const GltfNodes& nodes,
                                      std::size_t index);

/// Computes the map of one vertex: the mean of its joints' maps by its weights, of all sets. The
/// sum of the weights, which writers round, is divided out. A warning reports a sum far from 1.
///
/// @param primitive  has influences
/// @throws ParseError  a joint that the skin does not have, a weight that is negative or not
///         finite, weights that are all zero
[[nodiscard]] Eigen::Affine3d blend(const GltfDocument& document, const GltfPrimitive& primitive,
                                    const GltfSkin& skin, std::size_t vertex);

}  // namespace firstcontact::detail
