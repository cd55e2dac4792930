/// @file
/// The triangles of a surface that slides in itself, in an order that keeps neighbours together.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/screw_sliding.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// Sorts the triangles by their part of the profile, then along the screw thread; kNoTriangle fills
/// gaps.
[[nodiscard]] FIRSTCONTACT_API std::vector<std::uint32_t> order_along(
    const ScrewSliding& screw_sliding, const Hierarchy& hierarchy);

}  // namespace firstcontact
