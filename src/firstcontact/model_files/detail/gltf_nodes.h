/// @file
/// The node trees of a glTF document.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/gltf_document.h>

namespace firstcontact::detail {

/// All nodes of a document, placed.
struct GltfNodes {
  std::vector<Eigen::Affine3d> X_WN;  ///< Maps from each node's frame to the world's.
  /// The nodes of the scene that is read, parents before children, in the order of a depth-first
  /// walk.
  std::vector<std::size_t> scene;
};

/// Places the nodes, and chooses the scene.
///
/// The scene is the one that the document names as default, or the first where it names none.
/// Without scenes it is all trees of nodes.
///
/// Maps are multiplied in double precision along each path from the root: a product's entries are
/// rounded. Depth and number of nodes have no limit. A node with a mesh that is outside of the
/// scene is left out with a warning.
///
/// @throws ParseError  a node inside of itself, a node with two parents, a node of a scene that has
///         a parent, an index out of range
[[nodiscard]] GltfNodes place_nodes(const GltfDocument& document);

/// Makes the name of a node's place in the document: "nodes[7]".
[[nodiscard]] std::string place_of_node(std::size_t node);

}  // namespace firstcontact::detail
