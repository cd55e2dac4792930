#include <firstcontact/geometry/height_map.h>

#include <cstdint>
#include <stdexcept>
#include <utility>

#include <firstcontact/geometry/primitives.h>

namespace firstcontact {
namespace {

void validate(const HeightMap& map) {
  if (!(map.cell.minCoeff() >= kLeastSize && map.cell.maxCoeff() <= kGreatestSize)) {
    throw std::invalid_argument("make_height_map: cell must be in 1e-60 ... 1e60");
  }
  if (map.columns < 2 || map.heights.size() / map.columns < 2 ||
      map.heights.size() % map.columns != 0) {
    throw std::invalid_argument("make_height_map: expected two full rows of two heights or more");
  }
}

}  // namespace

Shape make_height_map(const HeightMap& map, double radius) {
  validate(map);
  const std::size_t rows = map.heights.size() / map.columns;
  Mesh mesh;
  mesh.vertices.reserve(map.heights.size());
  mesh.triangles.reserve(2 * (rows - 1) * (map.columns - 1));
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < map.columns; ++k) {
      const std::size_t sample = i * map.columns + k;
      mesh.vertices.emplace_back(static_cast<double>(k) * map.cell.x(),
                                 static_cast<double>(i) * map.cell.y(), map.heights[sample]);
      if (i + 1 < rows && k + 1 < map.columns) {
        const auto a = static_cast<std::uint32_t>(sample);
        const auto c = static_cast<std::uint32_t>(sample + map.columns);
        mesh.triangles.push_back({a, a + 1, c + 1});
        mesh.triangles.push_back({a, c + 1, c});
      }
    }
  }
  return Shape(std::move(mesh), radius);
}

}  // namespace firstcontact
