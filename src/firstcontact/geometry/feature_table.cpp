#include <firstcontact/geometry/feature_table.h>

#include <algorithm>
#include <cassert>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/needle.h>
#include <firstcontact/geometry/shape.h>

namespace firstcontact {
namespace {

std::uint8_t small(std::size_t number) {
  assert(number < FeatureTable::kMostNumbers);
  return static_cast<std::uint8_t>(number);
}

/// Numbers the vertices of the hierarchy: by their rank in the mesh among those of triangles.
std::vector<std::uint8_t> vertex_numbers(const Hierarchy& hierarchy) {
  std::vector<std::uint32_t> sorted = hierarchy.vertex_index;
  std::ranges::sort(sorted);
  std::vector<std::uint8_t> numbers;
  numbers.reserve(sorted.size());
  for (const std::uint32_t v : hierarchy.vertex_index) {
    numbers.push_back(
        small(static_cast<std::size_t>(std::ranges::lower_bound(sorted, v) - sorted.begin())));
  }
  return numbers;
}

void list_indices(const Shape& shape, FeatureTable& table) {
  const Hierarchy& hierarchy = shape.hierarchy();
  table.index = hierarchy.vertex_index;
  std::ranges::sort(table.index);
  table.first_edge = table.index.size();
  for (std::uint32_t edge = 0; edge < shape.edge_count(); ++edge) {
    table.index.push_back(edge);
  }
  table.first_face = table.index.size();
  for (std::uint32_t face = 0; face < hierarchy.triangles.size(); ++face) {
    table.index.push_back(face);
  }
}

}  // namespace

FeatureTable feature_table(const Shape& shape) {
  const Hierarchy& hierarchy = shape.hierarchy();
  assert(hierarchy.triangles.size() <= FeatureTable::kMostTriangles);
  const auto own = shape.own_features();
  const std::vector<std::uint8_t> numbers = vertex_numbers(hierarchy);
  FeatureTable table;
  list_indices(shape, table);
  for (std::size_t a = 0; a < hierarchy.triangles.size(); ++a) {
    const auto& corners = hierarchy.triangles[a];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = corners[k];
      const std::uint32_t to = corners[(k + 1) % 3];
      if ((own[a] & 1u << k) != 0) {
        table.corners.push_back({small(a), small(k), small(from), numbers[from]});
      }
      if ((own[a] & 8u << k) != 0) {
        const std::size_t number =
            from == to ? numbers[from]
                       : table.first_edge + shape.edge_index(hierarchy.vertex_index[from],
                                                             hierarchy.vertex_index[to]);
        table.edges.push_back({small(a),
                               small(k),
                               {small(from), small(to)},
                               {numbers[from], numbers[to]},
                               small(number)});
      }
    }
    table.has_needles = table.has_needles || is_needle(hierarchy.vertex(corners[0], 0.0),
                                                       hierarchy.vertex(corners[1], 0.0),
                                                       hierarchy.vertex(corners[2], 0.0));
    table.faces.push_back({{small(corners[0]), small(corners[1]), small(corners[2])},
                           small(table.first_face + hierarchy.triangle_index[a])});
  }
  return table;
}

}  // namespace firstcontact
