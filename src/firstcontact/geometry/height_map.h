/// @file
/// Height maps: terrain over a regular grid.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Heights over a grid in the plane z = 0 whose first sample is at the origin: that of row i and
/// column k is at (k cell.x, i cell.y).
struct HeightMap {
  Eigen::Vector2d cell = Eigen::Vector2d::Ones();  ///< [m]  Distance of neighbouring samples; > 0.
  std::size_t columns = 0;                         ///< Of samples, along x; >= 2.
  std::vector<double> heights;                     ///< [m]  Row by row; >= 2 rows.
};

/// The surface through the samples, two triangles a cell: cell (i, k) has the faces 2 (i (columns -
/// 1) + k), on the side of +x of its diagonal to larger x and y, and the next. Vertex i columns + k
/// is a sample.
///
/// @param radius  [m]  thickens the surface; >= 0
/// @throws std::invalid_argument as Shape, and where the map is not as documented
[[nodiscard]] FIRSTCONTACT_API Shape make_height_map(const HeightMap& map, double radius = 0.0);

}  // namespace firstcontact
