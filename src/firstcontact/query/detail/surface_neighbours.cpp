#include <firstcontact/query/detail/surface_neighbours.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The sine of the angle by which rounding may tilt a direction between points that are near.
constexpr double kTilt = 1e-6;

/// Sorts pairs of (feature, vector) into rows.
template <class Rows>
Rows in_rows(std::size_t count, const NeighbourSlack& slack,
             std::vector<std::pair<std::uint32_t, Vector3d>>&& pairs) {
  std::ranges::stable_sort(pairs, {}, [](const auto& pair) { return pair.first; });
  Rows rows;
  rows.first.assign(count + 1, 0);
  for (const auto& [feature, vector] : pairs) {
    ++rows.first[feature + 1];
    const double length = vector.norm();
    rows.offsets.push_back(
        {vector, std::max(length < slack.far_from ? slack.beside : slack.far, kTilt * length)});
  }
  for (std::size_t k = 0; k < count; ++k) {
    rows.first[k + 1] += rows.first[k];
  }
  return rows;
}

/// Whether an edge with these offsets across its faces divides a flat face.
template <class Offset>
bool are_flat(std::span<const Offset> offsets) {
  if (offsets.size() != 2) {
    return false;
  }
  const Vector3d& a = offsets[0].vector;
  const Vector3d& b = offsets[1].vector;
  return a.dot(b) < 0.0 && a.cross(b).norm() <= kTilt * a.norm() * b.norm();
}

}  // namespace

SurfaceNeighbours::SurfaceNeighbours(const Shape& shape, const NeighbourSlack& slack) {
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
  edges_ = in_rows<OffsetRows>(shape.edge_count(), slack, std::move(across_faces));
  vertices_ = in_rows<OffsetRows>(mesh.vertices.size(), slack, std::move(along_edges));
  for (std::uint32_t e = 0; e < shape.edge_count(); ++e) {
    is_flat_.push_back(are_flat(edges_.of(e)));
  }
  find_flat_vertices(shape);
  find_straight_vertices(shape);
  find_flat_faces(shape);
}

void SurfaceNeighbours::find_flat_vertices(const Shape& shape) {
  for (std::uint32_t v = 0; v < shape.mesh().vertices.size(); ++v) {
    is_flat_vertex_.push_back(!vertices_.of(v).empty());
  }
  for (std::uint32_t e = 0; e < shape.edge_count(); ++e) {
    for (const std::uint32_t end : shape.edge(e)) {
      is_flat_vertex_[end] = is_flat_vertex_[end] && is_flat_[e];
    }
  }
}

void SurfaceNeighbours::find_straight_vertices(const Shape& shape) {
  const std::vector<Vector3d>& vertices = shape.mesh().vertices;
  std::vector<int> bends(vertices.size(), 0);  // Number of edges that divide no flat face.
  std::vector<Vector3d> first(vertices.size(), Vector3d::Zero());
  is_straight_vertex_.assign(vertices.size(), false);
  for (std::uint32_t e = 0; e < shape.edge_count(); ++e) {
    const std::array<std::uint32_t, 2> ends = shape.edge(e);
    for (std::size_t k = 0; k < 2 && !is_flat_[e]; ++k) {
      const std::uint32_t v = ends[k];
      const Vector3d along = (vertices[ends[1 - k]] - vertices[v]).stableNormalized();
      if (++bends[v] == 1) {
        first[v] = along;
      }
      is_straight_vertex_[v] =
          bends[v] == 2 && along.dot(first[v]) < 0.0 && along.cross(first[v]).norm() <= kTilt;
    }
  }
}

Extent SurfaceNeighbours::extent(const Feature& feature) const {
  switch (feature.type) {
    case FeatureType::vertex:
      return is_flat_vertex_[feature.index]       ? Extent::plane
             : is_straight_vertex_[feature.index] ? Extent::line
                                                  : Extent::corner;
    case FeatureType::edge:
      return is_flat_[feature.index] ? Extent::plane : Extent::line;
    case FeatureType::face:
      break;
  }
  return Extent::plane;
}

void SurfaceNeighbours::find_flat_faces(const Shape& shape) {
  const std::vector<std::array<std::uint32_t, 3>>& triangles = shape.mesh().triangles;
  flat_face_.resize(triangles.size());
  std::iota(flat_face_.begin(), flat_face_.end(), 0U);
  const auto first_of = [&](std::uint32_t t) {
    while (flat_face_[t] != t) {
      t = flat_face_[t] = flat_face_[flat_face_[t]];
    }
    return t;
  };
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> beside(shape.edge_count(), kNone);  // The first triangle of each edge.
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k];
      const std::uint32_t b = triangles[t][(k + 1) % 3];
      if (a == b) {
        continue;
      }
      const std::uint32_t e = shape.edge_index(a, b);
      if (is_flat_[e] && beside[e] != kNone) {
        const auto [least, other] = std::minmax({first_of(beside[e]), first_of(t)});
        flat_face_[other] = least;
      }
      beside[e] = t;
    }
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    flat_face_[t] = first_of(t);
  }
}

double SurfaceNeighbours::flat_around(const Feature& feature) const {
  if (!is_flat_edge(feature) &&
      !(feature.type == FeatureType::vertex && is_flat_vertex_[feature.index])) {
    return 0.0;
  }
  double least = std::numeric_limits<double>::infinity();
  for_each_offset(feature, [&](const Vector3d& offset) { least = std::min(least, offset.norm()); });
  return least;
}

bool SurfaceNeighbours::none_is_farther(std::span<const Offset> offsets,
                                        const Vector3d& direction_B) {
  return std::ranges::all_of(
      offsets, [&](const Offset& offset) { return offset.vector.dot(direction_B) <= offset.most; });
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

}  // namespace firstcontact::detail
