#include <firstcontact/dynamics/detail/surface_neighbours.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The sine of the angle by which rounding may tilt a direction between points that are near.
constexpr double kTilt = 1e-6;

/// Sorts pairs of (feature, way) into rows.
template <class Ways>
Ways in_rows(std::size_t count, std::vector<std::pair<std::uint32_t, Vector3d>>&& pairs) {
  std::ranges::stable_sort(pairs, {}, [](const auto& pair) { return pair.first; });
  Ways rows;
  rows.first.assign(count + 1, 0);
  for (const auto& [feature, way] : pairs) {
    ++rows.first[feature + 1];
    rows.ways.push_back(way);
  }
  for (std::size_t k = 0; k < count; ++k) {
    rows.first[k + 1] += rows.first[k];
  }
  return rows;
}

}  // namespace

SurfaceNeighbours::SurfaceNeighbours(const Shape& shape, double slack) : slack_(slack) {
  const Mesh& mesh = shape.mesh();
  std::vector<std::pair<std::uint32_t, Vector3d>> across_faces;
  std::vector<std::pair<std::uint32_t, Vector3d>> along_edges;
  for (std::size_t e = 0; e < shape.edge_count(); ++e) {
    const auto [a, b] = shape.edge(e);
    const Vector3d along = mesh.vertices[b] - mesh.vertices[a];
    along_edges.emplace_back(a, along);
    along_edges.emplace_back(b, -along);
  }
  for (const auto& corners : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[(k + 1) % 3];
      if (a == b) {
        continue;
      }
      const Vector3d along = (mesh.vertices[b] - mesh.vertices[a]).stableNormalized();
      const Vector3d side = mesh.vertices[corners[(k + 2) % 3]] - mesh.vertices[a];
      const Vector3d across = side - side.dot(along) * along;
      if (across.squaredNorm() > 0.0) {
        across_faces.emplace_back(shape.edge_index(a, b), across);
      }
    }
  }
  edges_ = in_rows<Ways>(shape.edge_count(), std::move(across_faces));
  vertices_ = in_rows<Ways>(mesh.vertices.size(), std::move(along_edges));
}

bool SurfaceNeighbours::none_is_farther(std::span<const Vector3d> ways,
                                        const Vector3d& direction_B) const {
  return std::ranges::all_of(ways, [&](const Vector3d& way) {
    return way.dot(direction_B) <= std::max(slack_, kTilt * way.norm());
  });
}

bool SurfaceNeighbours::is_outermost(const Feature& feature, const Vector3d& direction_B) const {
  switch (feature.type) {
    case FeatureType::vertex:
      return none_is_farther(vertices_.of(feature.index), direction_B);
    case FeatureType::edge:
      return none_is_farther(edges_.of(feature.index), direction_B);
    case FeatureType::face:
      break;
  }
  return true;
}

bool SurfaceNeighbours::is_flat_edge(const Feature& feature) const {
  if (feature.type != FeatureType::edge) {
    return false;
  }
  const std::span<const Vector3d> ways = edges_.of(feature.index);
  return ways.size() == 2 && ways[0].dot(ways[1]) < 0.0 &&
         ways[0].cross(ways[1]).norm() <= kTilt * ways[0].norm() * ways[1].norm();
}

}  // namespace firstcontact::detail
