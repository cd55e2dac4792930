/// @file
/// What is drawn of a shape: its triangles, or the ball or the capsule that they stand for.

#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {

struct DrawnMesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]  Of the vertices, in the body frame.
  std::vector<float> vertices;                       ///< [m]  x, y, z of each.
  std::vector<std::uint32_t> corners;                ///< Three of each triangle; none of points.
};

/// Vertices are relative to the middle, so that single precision suffices far from the origin too.
[[nodiscard]] DrawnMesh drawn_mesh(const Shape& shape);

}  // namespace firstcontact::detail
