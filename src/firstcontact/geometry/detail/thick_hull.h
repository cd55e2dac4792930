/// @file
/// Volume, centre of mass and inertia of a convex polyhedron that a radius thickens.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// Whether no edge of a closed mesh is bent inwards, beyond rounding.
///
/// @param sign  1 where the triangles face outwards, -1 where they face inwards
[[nodiscard]] bool is_convex(const Mesh& mesh, double sign);

/// Adds the space within a radius of a convex polyhedron to the integrals over the polyhedron.
///
/// That space has a prism on each face, a sector of a cylinder on each edge, and a sector of a ball
/// on each corner. The sectors of corners make up a whole ball (J. Steiner, 1840). Exact but for
/// rounding.
///
/// @param core    over the polyhedron; its volume may be 0, of a polygon with two faces
/// @param mesh    its triangles: closed, each vertex once
/// @param sign    as of is_convex()
/// @param radius  [m]  > 0
[[nodiscard]] MassProperties thickened(const MassProperties& core, const Mesh& mesh, double sign,
                                       double radius);

}  // namespace firstcontact::detail
