/// @file
/// The hierarchy of one box around a convex core.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {

/// Makes a single box, which counts as the box of one triangle; that triangle is a point at the
/// centre.
///
/// The box contains the core exactly. Its extents are upper bounds of the support function along
/// its own axes.
///
/// @param core    its origin is at `centre`
/// @param centre  [m]  in the body frame
[[nodiscard]] Hierarchy convex_hierarchy(const ConvexCore& core, const Eigen::Vector3d& centre);

}  // namespace firstcontact::detail
