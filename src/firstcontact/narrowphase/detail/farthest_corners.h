/// @file
/// The corners of a polytope that are farthest along a few directions.

#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <firstcontact/geometry/shape_bounds.h>

namespace firstcontact::detail {

/// Most directions at once: corners are then read only once.
inline constexpr std::size_t kDirections = 3;

/// Finds for each direction the row whose product with it is greatest, up to rounding.
///
/// It is the first if there are several, or if the product is not a number. Several corners are
/// taken at a time, as many as the processor can.
///
/// @param corners     one at least
/// @param directions  1 or kDirections, in the corners' axes
[[nodiscard]] std::array<Eigen::Index, kDirections> farthest_corners(
    const PointRows& corners, std::span<const Eigen::Vector3d> directions);

}  // namespace firstcontact::detail
