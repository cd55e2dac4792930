/// @file
/// The verifier's own hierarchy: boxes over the triangles of a body, relative to its pivot.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {

/// A box with its faces along the axes of the body, around one triangle or two other boxes.
struct BoxNode {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Centre from the pivot.
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< [m]  Half lengths of its edges, rounded
                                                     ///< up.
  double reach = 0.0;  ///< [m]  Bound of the distance of its points from the pivot.
  bool is_leaf = false;
  std::uint32_t first = 0;  ///< Its triangle, or the first of its two children, which are adjacent.
};

/// The boxes and the triangles of a body. Corners are within 2^-53 of their distance from the
/// pivot.
struct BoxTree {
  std::vector<BoxNode> nodes;                             ///< Nodes; the root is the first.
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;  ///< [m]  Corners from the pivot.
};

/// Builds the boxes over a mesh.
///
/// @param mesh  at least one triangle
/// @param p_BC  [m]  the pivot
[[nodiscard]] BoxTree build_box_tree(const Mesh& mesh, const Eigen::Vector3d& p_BC);

/// Builds the boxes over a shape; of a curved one (Shape::is_curved()) a single box without
/// triangles.
[[nodiscard]] BoxTree build_box_tree(const Shape& shape, const Eigen::Vector3d& p_BC);

}  // namespace firstcontact::detail
