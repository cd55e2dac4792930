/// @file
/// A mesh whose vertices each move on a line of their own.

#pragma once

#include <span>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact {

/// A body whose vertices move: its deforming shape, and the motion of its frame. The two belong
/// together.
struct DeformingBody {
  Shape shape;  ///< Deforms about its centre.
  Motion X_WS;  ///< Carries the centre from the middle of the mesh at t = 0 to that at t = 1.
};

/// Moves every vertex i of the shape from its coordinates to to[i], world frame.
///
/// At t it is exactly at (1 - t) shape.mesh().vertices[i] + t to[i].
///
/// @param to  [m]  one for each vertex of the mesh
/// @throws std::invalid_argument as Shape::deforming does
[[nodiscard]] FIRSTCONTACT_API DeformingBody move_vertices(const Shape& shape,
                                                           std::span<const Eigen::Vector3d> to);

}  // namespace firstcontact
