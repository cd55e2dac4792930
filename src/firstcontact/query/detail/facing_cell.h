/// @file
/// Cells of contacts that lie beside each other and face alike.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/math/cell_hash.h>

namespace firstcontact::detail {

/// A cell of a grid, and the octant of a normal; a key for CellHash.
using FacingCell = std::array<std::int64_t, 4>;

/// The cell of a place and a normal.
///
/// @param n     normal of any length
/// @param edge  [m]  edge of a cell of the grid; > 0
inline FacingCell facing_cell(const Eigen::Vector3d& place, const Eigen::Vector3d& n, double edge) {
  FacingCell cell{0, 0, 0, (n.x() > 0.0 ? 1 : 0) + (n.y() > 0.0 ? 2 : 0) + (n.z() > 0.0 ? 4 : 0)};
  for (int k = 0; k < 3; ++k) {
    cell[static_cast<std::size_t>(k)] = cell_along(place[k], edge);
  }
  return cell;
}

}  // namespace firstcontact::detail
