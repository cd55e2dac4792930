/// @file
/// Cells of grids as keys.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace firstcontact {

/// Computes the cell of a coordinate on a line of cells. Cells too far out to be counted share the
/// last one.
///
/// @param edge  length of a cell, in the unit of the coordinate; > 0
///
/// @param edge  > 0, in the unit of the coordinate
inline std::int64_t cell_along(double coordinate, double edge) {
  constexpr double kLast = 0x1p52;
  return static_cast<std::int64_t>(
      std::fmin(std::fmax(std::floor(coordinate / edge), -kLast), kLast));
}

/// A hash of the integers that name a cell.
struct CellHash {
  template <std::size_t size>
  std::size_t operator()(const std::array<std::int64_t, size>& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace firstcontact
