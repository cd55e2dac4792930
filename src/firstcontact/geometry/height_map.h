/// @file
/// Height maps: terrain over a regular grid.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Heights over a regular grid in the plane z = 0.
///
/// The first sample is at the origin. The sample of row i and column k is at (k cell.x, i cell.y).
struct HeightMap {
  Eigen::Vector2d cell = Eigen::Vector2d::Ones();  ///< [m]  Distance of neighbouring samples; > 0.
  std::size_t columns = 0;                         ///< Samples of a row, along x; >= 2.
  std::vector<double> heights;                     ///< [m]  Row by row; >= 2 rows.
};

/// Makes the surface through the samples of a map, with two triangles a cell.
///
/// Cell (i, k) has the faces 2 (i (columns - 1) + k) and the next. The first one lies on the side
/// of +x of the cell's diagonal to larger x and y. Vertex i columns + k is the sample of row i and
/// column k.
///
/// @param radius  [m]  thickens the surface; >= 0
/// @throws std::invalid_argument as Shape, and where the map is not as documented
[[nodiscard]] FIRSTCONTACT_API Shape make_height_map(const HeightMap& map, double radius = 0.0);

}  // namespace firstcontact
