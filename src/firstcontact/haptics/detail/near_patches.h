/// @file
/// The parts of two convex bodies that can be near each other.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/placed_shape.h>

namespace firstcontact::detail {

/// Some triangles of a shape as a shape of their own.
struct SurfacePatch {
  Shape shape;
  std::vector<std::uint32_t> vertices;   ///< For each vertex its index in the whole shape.
  std::vector<std::uint32_t> triangles;  ///< For each triangle its index there.

  /// Finds the same feature of the whole shape.
  [[nodiscard]] Feature in_whole(const Shape& whole, const Feature& feature) const;
};

/// The parts of two bodies that hold all features within a band.
struct NearPatches {
  bool are_apart = false;  ///< Whether no features are within the band; then there are no patches.
  std::optional<std::array<SurfacePatch, 2>> patches = {};  ///< None where they would be large.
};

/// Finds the triangles of two bodies that can be within a band of the other body.
///
/// Derivation: let n be any direction, h the greatest n . a over A, and g the gap n . b - h of the
/// nearest b of B along it. Points a and b with |b - a| <= band have n . b - n . a <= band, and
/// n . b >= h + g. So n . a >= h - (band - g), and likewise for b. Convex bodies have few triangles
/// in these slabs if n separates them best. The slabs are larger than rounding needs.
///
/// @param band  [m]  >= 0; radii are included in distances
[[nodiscard]] NearPatches near_patches(const PlacedShape& A, const PlacedShape& B, double band);

}  // namespace firstcontact::detail
