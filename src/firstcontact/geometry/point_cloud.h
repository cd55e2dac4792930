/// @file
/// Point clouds.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Makes the shape of points thickened by a radius: a union of balls. Vertex k and triangle k are
/// point k.
///
/// @param points  [m]  at least one
/// @param radius  [m]  >= 0
/// @throws std::invalid_argument as Shape
[[nodiscard]] FIRSTCONTACT_API Shape make_point_cloud(std::vector<Eigen::Vector3d> points,
                                                      double radius = 0.0);

}  // namespace firstcontact
