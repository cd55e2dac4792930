/// @file
/// The verifier's own test of a point and a solid.

#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/interval_vector.h>

namespace firstcontact::detail {

/// Whether the triangles wind around the point, proven either way.
///
/// There is no answer where the point is too close to them.
///
/// @param mesh  closed; its triangles agree on their inner side
/// @param p     [m]  contains the point, in the mesh's frame
[[nodiscard]] std::optional<bool> is_inside(const Mesh& mesh, const IntervalVector3& p);

/// [m]  A point of each component of a shape, exact; of a curved one its centre.
[[nodiscard]] std::vector<Eigen::Vector3d> points_of_components(const Shape& shape);

}  // namespace firstcontact::detail
