/// @file
/// Whether one body lies inside another that is solid.

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
  bool vertex_of_A = false;  ///< Of B otherwise.
  bool is_set = false;       ///< The origin of a convex set in place of a vertex.
  std::uint32_t vertex = 0;  ///< In the hierarchy's order.
  std::uint32_t face = 0;    ///< Triangle of the other body, in its hierarchy's order.
};

/// Looks for a vertex of A in a solid B, or of B in a solid A, at one instant.
///
/// Where the surfaces do not touch, the bodies have a point in common only if a whole component of
/// one lies in the other: testing one vertex of each is enough. `no` and `yes` are proven;
/// `unsure` only where a vertex is about as close to the surface as positions are rounded.
///
/// Two convex sets need no such look: their closest points tell it. Neither does a body in a convex
/// set, as a triangle inside is at distance 0. For a convex set in a solid its own origin is
/// tested.
///
/// Derivation: take any ray from the point that meets no edge. The winding number of a closed
/// surface around the point is how often the ray leaves through it, less how often it enters. The
/// signs of the volumes that decide are certified for all points within gap_error of the rounded
/// ones; a ray that passes an edge too closely is given up for another.
Containment find_containment(const Shape& A, const Shape& B, const MovingPair& pair,
                             const RelativeState& state);

/// The contact of a contained body: its vertex and the face, both points at the vertex, distance 0,
/// no normal.
Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                     const Containment& found);

}  // namespace firstcontact::detail
