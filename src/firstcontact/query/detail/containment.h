/// @file
/// A test whether one body lies inside another that is solid.

#pragma once

#include <cstdint>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/detail/contact_state.h>

namespace firstcontact::detail {

/// The relation of a point to a solid, as far as it is known.
enum class Inside { no, yes, unsure };

/// Whether the triangles of a surface wind around a point other than zero times.
///
/// @param p_CP   [m]  the point, from the centre of the hierarchy
/// @param error  [m]  the exact point is no farther from it than this
[[nodiscard]] Inside winds_around(const Hierarchy& surface, const Eigen::Vector3d& p_CP,
                                  double error);

/// A vertex of one body that lies in the other, and a face of that which encloses it.
struct Containment {
  Inside inside = Inside::no;
  bool vertex_of_A = false;  ///< Whether the vertex is one of A, else of B.
  bool is_set = false;       ///< Whether the origin of a convex set takes the place of a vertex.
  std::uint32_t vertex = 0;  ///< In the hierarchy's order.
  std::uint32_t face = 0;    ///< Triangle of the other body, in its hierarchy's order.
};

/// Looks for a vertex of A in a solid B, or of B in a solid A, at one instant.
///
/// Where the surfaces do not touch, the bodies have a point in common only if a whole component of
/// one lies in the other. So one vertex of each component is tested. `no` and `yes` are proven.
/// `unsure` comes only where a vertex is about as close to the surface as positions are rounded.
///
/// Two convex sets need no such test, as their closest points decide. Neither does a body in a
/// convex set, as a triangle inside is at distance 0. For a convex set in a solid its own origin is
/// tested.
///
/// Derivation: take any ray from the point that meets no edge. The winding number of a closed
/// surface around the point counts how often the ray leaves through it, less how often it enters.
/// The signs of the volumes that decide are certified for all points within gap_error of the
/// rounded ones. A ray that passes an edge too closely is given up for another.
Containment find_containment(const Shape& A, const Shape& B, const MovingPair& pair,
                             const RelativeState& state);

/// Makes the contact of a contained body: its vertex and the face.
///
/// Both points are at the vertex, with distance 0 and no normal.
Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                     const Containment& found);

}  // namespace firstcontact::detail
