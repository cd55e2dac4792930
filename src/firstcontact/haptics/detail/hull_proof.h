/// @file
/// Proofs of convex members by their hulls, in place of their triangles.

#pragma once

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Whether the triangles of a shape bound their convex hull, to within a slack.
///
/// True for the triangles around a cylinder, a cone or an ellipsoid, and for convex meshes. False
/// for large meshes, where looking for points of the hull takes long.
///
/// @param slack  [m]  >= 0  the most by which a vertex may lie outside of a triangle's plane
[[nodiscard]] bool is_convex(const Shape& shape, double slack);

/// Finds the first contact of the convex hulls of two shapes, as first_contact() does for the
/// shapes.
///
/// What is proven for the hulls holds for the shapes in them. A contact of the hulls is one of the
/// shapes where is_convex() holds for both, to the slacks. The work does not depend on how many
/// triangles are near: a step takes two convex sets. So it is short where thin triangles of two
/// cylinders cross.
///
/// @param result  receives verdict, reason, t and work; no contacts
void first_contact_of_hulls(const MovingShape& A, const MovingShape& B,
                            const FirstContactOptions& options, FirstContactResult& result);

}  // namespace firstcontact::detail
