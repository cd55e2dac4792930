/// @file
/// Bodies that begin inside of the surface of another one.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A shape S where a step begins. Refers to the shape.
struct ShapeAtStart {
  const Shape* shape = nullptr;
  Pose X_WS = {};
};

/// Two shapes by their index.
struct BeginsInside {
  std::size_t inside = 0;
  std::size_t around = 0;

  friend bool operator==(const BeginsInside&, const BeginsInside&) = default;
};

/// Finds shapes that begin inside of meshes that are surfaces (Filling::surface).
///
/// Were these meshes solids, the two would be in contact from the start. One point of each shape is
/// tested, so a shape of several components may be missed. An answer is certified: the surface
/// winds around the point other than zero times. Whether the surface is closed is not tested: see
/// why_not_solid().
///
/// The search for points within a surface's bounds takes O(n log n). Only such points cost more.
///
/// @returns in the order of `around`, then of `inside`
[[nodiscard]] FIRSTCONTACT_API std::vector<BeginsInside> find_begins_inside(
    std::span<const ShapeAtStart> shapes);

}  // namespace firstcontact
