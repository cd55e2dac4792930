/// @file
/// Primitive solids: sphere, capsule, box, cylinder, cone, ellipsoid.

#pragma once

#include <optional>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// [m]  The least and the greatest length of a primitive. Products of three lengths neither
/// overflow nor underflow.
inline constexpr double kLeastSize = 1e-60;
inline constexpr double kGreatestSize = 1e60;

/// [-]  The least enclosure error of a cylinder or a cone, as a fraction of its radius.
inline constexpr double kLeastEnclosureError = 1e-8;

/// [-]  The least enclosure error of an ellipsoid, as a fraction of its greatest radius. It takes
/// 50,000 triangles.
inline constexpr double kLeastEllipsoidError = 2e-4;

/// [-]  The least radius of an ellipsoid, as a fraction of its greatest. For flatter ellipsoids the
/// squares of normals underflow.
inline constexpr double kFlattestEllipsoid = 1e-30;

/// Makes a ball about the origin. Its one feature is vertex 0, the centre.
///
/// @param radius  [m]  > 0
/// @throws std::invalid_argument where a length is not finite or not in its range; so do all
/// functions of this file
[[nodiscard]] FIRSTCONTACT_API Shape make_sphere(double radius);

/// Makes a capsule: all points within the radius of a segment along z, centred at the origin.
///
/// Features: edge 0, the segment; vertices 0 and 1, its lower and upper end.
///
/// @param radius  [m]  > 0
/// @param length  [m]  of the segment, without the caps; >= 0
[[nodiscard]] FIRSTCONTACT_API Shape make_capsule(double radius, double length);

/// Makes a box along the axes, centred at the origin; with a radius, a rounded box.
///
/// Faces 0 and 1 make the side at -x, then two each for +x, -y, +y, -z, +z. Vertex k is at +x where
/// bit 0 of k is set, +y for bit 1, +z for bit 2.
///
/// @param size    [m]  of the box along each axis, without the radius; > 0
/// @param radius  [m]  thickens the box on all sides, and rounds its edges and corners; >= 0
[[nodiscard]] FIRSTCONTACT_API Shape make_box(const Eigen::Vector3d& size, double radius = 0.0);

/// Makes a cylinder about z, centred at the origin.
///
/// Queries of rigid bodies take it exactly (Shape::convex_set()). Its triangles enclose it: a prism
/// of n sides. They serve drawing, simulation and partners that deform.
///
/// Faces 0 to 2n - 1 are its sides, then n are at the bottom and n at the top. The ends are exact.
///
/// @param radius           [m]  > 0
/// @param length           [m]  along z; > 0
/// @param enclosure_error  [m]  the most by which the corners stand out; Shape::enclosure_error has
/// the actual amount. 1e-4 of the radius if none is given; at least 1e-8 of it
[[nodiscard]] FIRSTCONTACT_API Shape make_cylinder(double radius, double length,
                                                   std::optional<double> enclosure_error = {});

/// Makes a cone about z. As for make_cylinder(), queries take it exactly; its triangles are a
/// pyramid of n sides.
///
/// Its base is at z = -length / 2, its tip at length / 2. Faces 0 to n - 1 are its sides, then n
/// are at the base. Vertex n is the tip, exactly.
///
/// @param radius           [m]  of the base; > 0
/// @param length           [m]  along z; > 0
/// @param enclosure_error  [m]  as in make_cylinder
[[nodiscard]] FIRSTCONTACT_API Shape make_cone(double radius, double length,
                                               std::optional<double> enclosure_error = {});

/// Makes an ellipsoid along the axes, centred at the origin. As for make_cylinder(), queries take
/// it exactly.
///
/// Its triangles are a polyhedron of n sectors around z and m rings. Faces 0 to n - 1 are at the
/// bottom, 2n in each ring between, n at the top.
///
/// @param radii            [m]  half of the length along each axis; > 0, the least at least 1e-30
/// of the greatest
/// @param enclosure_error  [m]  as in make_cylinder; 5e-3 of the greatest radius if none is given,
///                         at least 2e-4 of it
[[nodiscard]] FIRSTCONTACT_API Shape make_ellipsoid(const Eigen::Vector3d& radii,
                                                    std::optional<double> enclosure_error = {});

}  // namespace firstcontact
