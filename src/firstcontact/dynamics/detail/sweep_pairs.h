/// @file
/// Pairs of boxes that overlap.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::detail {

/// All overlapping pairs {a, b}, a < b, by their order. Sort and sweep along the axis in which the
/// boxes' centres spread most.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> overlapping_pairs(
    const std::vector<Eigen::AlignedBox3d>& boxes);

}  // namespace firstcontact::detail
