/// @file
/// Volume, centre of mass and inertia of the solid that a shape encloses.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Volume, centre of mass and inertia of a solid of density 1.
///
/// Times a density in kg/m^3, volume and inertia are the mass and its moments.
struct MassProperties {
  double volume = 0.0;                                ///< [m^3]  > 0
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< [m]  Centre of mass, in the body frame.
  Eigen::Matrix3d about_C = Eigen::Matrix3d::Zero();  ///< [m^5]  Inertia about C, body axes.
};

/// Computes the integrals over the solid that a shape encloses, exactly but for rounding.
///
/// The solid is the polyhedron that the triangles enclose, whether or not the shape counts as
/// solid. A radius around a convex shape that counts as solid belongs to it. For a thickened point
/// the solid is a ball, for a thickened edge a capsule, for a thickened flat hull a plate with a
/// round rim. Vertices at the same place count as one.
///
/// Triangles may all face outwards or all inwards; those around a cavity face into it. Space that
/// they wind around twice, as components that overlap do, counts twice. A radius around another
/// closed mesh has no mass: the polyhedron has it all. Cylinders, cones and ellipsoids
/// (Shape::is_curved()) have the integrals of the curved body, not those of the triangles around
/// it.
///
/// Precise far from the body frame's origin too: integrals are relative to the mesh.
///
/// @throws std::invalid_argument if the shape encloses no space: open edges, neighbours that face
/// opposite sides, no volume within rounding, a component inside out that is no cavity
[[nodiscard]] FIRSTCONTACT_API MassProperties mass_properties(const Shape& shape);

}  // namespace firstcontact
