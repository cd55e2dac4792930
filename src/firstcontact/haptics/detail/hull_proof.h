/// @file
/// Proofs of convex members by their hulls, in place of their triangles.

#pragma once

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Whether the triangles of a shape bound their convex hull, to within a slack.
///
/// True for the triangles around a cylinder, a cone or an ellipsoid, and for convex meshes. False
/// for large meshes, where looking for points of the hull takes long.
///
/// @param slack  [m]  >= 0  the most by which a vertex may lie outside of a triangle's plane
[[nodiscard]] bool fills_its_hull(const Shape& shape, double slack);

/// The hull of a shape's vertices, from the centre of its hierarchy; refers to the shape.
[[nodiscard]] ConvexCore hull_of(const Shape& shape);

/// Finds the first contact of the convex hulls of two shapes, as first_contact() does for the
/// shapes.
///
/// A shape lies in its hull, so a motion that is free for the hulls is free for the shapes. A
/// contact of the hulls is one of the shapes where both fill their hulls, to the slacks. The work
/// does not depend on how many triangles are near, as a step takes two convex sets. So it is short
/// where thin triangles of two cylinders cross.
///
/// @param result  receives verdict, reason, t [-] and work; no contacts
void first_contact_of_hulls(const MovingShape& A, const MovingShape& B,
                            const FirstContactOptions& options, FirstContactResult& result);

}  // namespace firstcontact::detail
