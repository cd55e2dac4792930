/// @file
/// The drawing of a shape: its triangles, or the ball or the capsule that they stand for.

#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {

/// A mesh as a page or an animation draws it.
struct DrawnMesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]  Origin of the vertices, in the body
                                                     ///< frame.
  std::vector<float> vertices;                       ///< [m]  x, y, z of each vertex.
  std::vector<std::uint32_t> corners;                ///< Three for each triangle; none for points.
};

/// Makes the drawing of a shape.
///
/// Vertices are relative to the middle, so that single precision suffices far from the origin, too.
[[nodiscard]] DrawnMesh drawn_mesh(const Shape& shape);

}  // namespace firstcontact::detail
