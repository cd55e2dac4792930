/// @file
/// Triangulates what closed chains of edges in the plane enclose.

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

/// Which windings are inside: all but 0, or those above 0, which leave holes open.
enum class WindingRule { any_winding, positive_winding };

/// Triangles inside closed rings, counter-clockwise where the winding number is positive.
///
/// Rings may touch themselves and each other at points and along edges. Each edge is covered: it
/// is an edge of a triangle, or, where nothing inside is beside it, a triangle with a repeated
/// corner. Where a point lies on an edge without being one of its ends, a flat triangle of the
/// three joins them, as in space the point may be off the edge. Without such contacts, n points
/// and h holes give n + 2 h - 2 triangles, none of them flat.
///
/// A sweep over the points cuts the inside into monotone pieces and triangulates them on the way;
/// all decisions are exact; time O(n log n). Sources: M. R. Garey, D. S. Johnson, F. P. Preparata,
/// R. E. Tarjan, "Triangulating a simple polygon", Information Processing Letters 7 (1978); the
/// crossings: M. I. Shamos, D. Hoey, "Geometric intersection problems", FOCS (1976).
///
/// @param points  distinct, in ascending order
/// @param edges   closed rings; no edge from a point to itself
/// @returns       nothing where edges cross each other between their ends, or where a winding
///                below 0 is met with WindingRule::positive_winding
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_rings(
    std::span<const PlanePoint> points, std::span<const RingEdge> edges, WindingRule rule);

}  // namespace firstcontact::detail
