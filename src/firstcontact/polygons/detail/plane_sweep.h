/// @file
/// Triangulates the inside of closed chains of edges in the plane.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/polygons/detail/exact_orientation.h>

namespace firstcontact::detail {

/// An edge of a ring, from one point to another, by number.
struct RingEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// The windings that are inside: all but 0, or those above 0, which leave holes open.
enum class WindingRule { any_winding, positive_winding };

/// Finds triangles inside closed rings, counter-clockwise where the winding number is positive.
///
/// Rings may touch themselves and each other at points and along edges. Each edge is covered: it is
/// an edge of a triangle. Where nothing inside is beside it, it is a triangle with a repeated
/// corner. A point may lie on an edge without being one of its ends. Then a flat triangle of the
/// three joins them, as in space the point may be off the edge. Without such contacts, n points and
/// h holes give n + 2 h - 2 triangles, none of them flat.
///
/// A sweep over the points cuts the inside into monotone polygons and triangulates them on the way.
/// All decisions are exact, and the time is O(n log n). Sources: M. R. Garey, D. S. Johnson, F. P.
/// Preparata, R. E. Tarjan, "Triangulating a simple polygon", Information Processing Letters 7
/// (1978). The crossings: M. I. Shamos, D. Hoey, "Geometric intersection problems", FOCS (1976).
///
/// @param points  distinct, in ascending order
/// @param edges   closed rings; no edge from a point to itself
/// @returns nothing where edges cross each other between their ends, or where a winding below 0
///         occurs with WindingRule::positive_winding
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_rings(
    std::span<const PlanePoint> points, std::span<const RingEdge> edges, WindingRule rule);

}  // namespace firstcontact::detail
