#include <firstcontact/dynamics/detail/surface_neighbours.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The sine of the angle by which rounding may tilt a direction between points that are near.
constexpr double kTilt = 1e-6;

/// Sorts pairs of (feature, direction) into rows.
template <class Directions>
Directions in_rows(std::size_t count, std::vector<std::pair<std::uint32_t, Vector3d>> pairs) {
  std::ranges::stable_sort(pairs, {}, [](const auto& pair) { return pair.first; });
  Directions rows;
  rows.first.assign(count + 1, 0);
  for (const auto& [feature, direction] : pairs) {
    ++rows.first[feature + 1];
    rows.directions.push_back(direction);
  }
  for (std::size_t k = 0; k < count; ++k) {
    rows.first[k + 1] += rows.first[k];
  }
  return rows;
}

}  // namespace

SurfaceNeighbours::SurfaceNeighbours(const Shape& shape) {
  const Mesh& mesh = shape.mesh();
  std::vector<std::pair<std::uint32_t, Vector3d>> into_faces;
  std::vector<std::pair<std::uint32_t, Vector3d>> along_edges;
  for (std::size_t e = 0; e < shape.edge_count(); ++e) {
    const auto [a, b] = shape.edge(e);
    const Vector3d along = (mesh.vertices[b] - mesh.vertices[a]).stableNormalized();
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
        into_faces.emplace_back(shape.edge_index(a, b), across.stableNormalized());
      }
    }
  }
  edges_ = in_rows<Directions>(shape.edge_count(), std::move(into_faces));
  vertices_ = in_rows<Directions>(mesh.vertices.size(), std::move(along_edges));
}

bool SurfaceNeighbours::is_outermost(const Directions& of, std::uint32_t index,
                                     const Vector3d& direction_B) {
  for (std::uint32_t k = of.first[index]; k < of.first[index + 1]; ++k) {
    if (of.directions[k].dot(direction_B) > kTilt) {
      return false;
    }
  }
  return true;
}

bool SurfaceNeighbours::is_outermost(const Feature& feature, const Vector3d& direction_B) const {
  switch (feature.type) {
    case FeatureType::vertex:
      return is_outermost(vertices_, feature.index, direction_B);
    case FeatureType::edge:
      return is_outermost(edges_, feature.index, direction_B);
    case FeatureType::face:
      break;
  }
  return true;
}

}  // namespace firstcontact::detail
