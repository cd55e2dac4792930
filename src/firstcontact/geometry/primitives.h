/// @file
/// Primitive solids: sphere, capsule, box, cylinder, cone.

#pragma once

#include <optional>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// [m]  Lengths of primitives lie between these, so that products of three neither over- nor
/// underflow.
inline constexpr double kLeastSize = 1e-60;
inline constexpr double kGreatestSize = 1e60;

/// [-]  Of the radius: no cylinder or cone is enclosed more tightly.
inline constexpr double kLeastEnclosureError = 1e-8;

/// A ball about the origin. Its one feature is vertex 0, the centre.
///
/// @param radius  [m]  > 0
/// @throws std::invalid_argument as all functions of this file, where a length is not finite or
///         not in its range
[[nodiscard]] FIRSTCONTACT_API Shape make_sphere(double radius);

/// All points within the radius of a segment along z, centred at the origin. Features: edge 0, the
/// segment; vertices 0 and 1, its lower and upper end.
///
/// @param radius  [m]  > 0
/// @param length  [m]  of the segment, without the caps; >= 0
[[nodiscard]] FIRSTCONTACT_API Shape make_capsule(double radius, double length);

/// A box along the axes, centred at the origin. Faces 0 and 1 make the side at -x, then two each
/// for +x, -y, +y, -z, +z. Vertex k is at +x where bit 0 of k is set, +y for bit 1, +z for bit 2.
///
/// @param size  [m]  of the whole box along each axis; > 0
[[nodiscard]] FIRSTCONTACT_API Shape make_box(const Eigen::Vector3d& size);

/// A cylinder about z, centred at the origin, enclosed by a prism of n sides: faces 0 to 2n - 1 its
/// sides, then n at the bottom and n at the top. The ends are exact.
///
/// @param radius           [m]  > 0
/// @param length           [m]  along z; > 0
/// @param enclosure_error  [m]  the corners stand out by at most this, and Shape::enclosure_error
///                         by how much they do; 1e-4 of the radius if none is given, at least 1e-8
///                         of it
[[nodiscard]] FIRSTCONTACT_API Shape make_cylinder(double radius, double length,
                                                   std::optional<double> enclosure_error = {});

/// A cone about z, its base at z = -length / 2, its tip at length / 2, enclosed by a pyramid of n
/// sides: faces 0 to n - 1 its sides, then n at the base; vertex n is the tip, exactly.
///
/// @param radius           [m]  of the base; > 0
/// @param length           [m]  along z; > 0
/// @param enclosure_error  [m]  as in make_cylinder
[[nodiscard]] FIRSTCONTACT_API Shape make_cone(double radius, double length,
                                               std::optional<double> enclosure_error = {});

}  // namespace firstcontact
