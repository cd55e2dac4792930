#include <firstcontact/model_files/detail/gltf_surface.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <firstcontact/model_files/detail/gltf_transform.h>

namespace firstcontact::detail {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Computes the index that would restart a strip; glTF forbids it.
std::size_t restart_of(GltfNumber type) { return (std::size_t{1} << (8 * size_of(type))) - 1; }

Eigen::Vector3d morphed(const GltfPrimitive& primitive, const std::vector<double>& weights,
                        std::size_t vertex) {
  Eigen::Vector3d p_MV = primitive.positions.vector3(vertex);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] != 0.0 && primitive.targets[i]) {
      p_MV += weights[i] * primitive.targets[i]->vector3(vertex);
    }
  }
  return p_MV;
}

bool is_identity(const Eigen::Affine3d& X) {
  return X.matrix() == Eigen::Affine3d::Identity().matrix();
}

}  // namespace

void GltfSurface::reserve(std::size_t vertices, std::size_t triangles) {
  mesh_.vertices.reserve(vertices);
  mesh_.triangles.reserve(triangles);
}

void GltfSurface::add(const GltfPrimitive& primitive, const GltfPlacement& placement) {
  if (primitive.triangle_count() == 0) {
    return;
  }
  select(primitive);
  if (used_.size() >= kNone - mesh_.vertices.size()) {
    document_.fail(*primitive.where, "expected fewer than 2^32 vertices in all");
  }
  for (std::size_t k = 0; k < used_.size(); ++k) {
    number_[used_[k]] = static_cast<std::uint32_t>(mesh_.vertices.size() + k);
  }
  const bool mirrored = add_vertices(primitive, placement);
  for (std::size_t i = 0; i < primitive.triangle_count(); ++i) {
    std::array<std::uint32_t, 3> triangle{};
    const std::array<std::size_t, 3> corners = primitive.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = number_[index(primitive, corners[k])];
    }
    if (mirrored) {
      std::swap(triangle[1], triangle[2]);
    }
    mesh_.triangles.push_back(triangle);
  }
  for (const std::uint32_t vertex : used_) {
    number_[vertex] = kNone;
  }
}

Mesh GltfSurface::finish() {
  mesh_.vertices.shrink_to_fit();
  mesh_.triangles.shrink_to_fit();
  return std::move(mesh_);
}

std::size_t GltfSurface::index(const GltfPrimitive& primitive, std::size_t corner) const {
  return primitive.indices ? static_cast<std::size_t>(primitive.indices->at(corner, 0)) : corner;
}

/// Finds the vertices that the triangles use, and checks the indices.
void GltfSurface::select(const GltfPrimitive& primitive) {
  if (number_.size() < primitive.positions.count()) {
    number_.resize(primitive.positions.count(), kNone);
  }
  used_.clear();
  if (primitive.indices) {
    select_indexed(primitive);
    return;
  }
  const std::size_t corners = primitive.mode == GltfMode::triangles ? 3 * primitive.triangle_count()
                                                                    : primitive.corner_count();
  used_.resize(corners);
  std::iota(used_.begin(), used_.end(), 0u);
}

void GltfSurface::select_indexed(const GltfPrimitive& primitive) {
  const std::size_t vertices = primitive.positions.count();
  const std::size_t restart = restart_of(primitive.indices->type());
  for (std::size_t corner = 0; corner < primitive.corner_count(); ++corner) {
    const std::size_t vertex = index(primitive, corner);
    if (vertex == restart || vertex >= vertices) {
      document_.fail(
          *primitive.where,
          "expected indices of its " + std::to_string(vertices) + " vertices, got " +
              std::to_string(vertex) + " as number " + std::to_string(corner) +
              (vertex == restart ? ", which restarts a strip, and glTF has no restarts" : ""));
    }
    if (number_[vertex] == kNone) {
      number_[vertex] = 0;
      used_.push_back(static_cast<std::uint32_t>(vertex));
    }
  }
  if (used_.size() < vertices / 8) {
    std::sort(used_.begin(), used_.end());
    return;
  }
  used_.clear();
  for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
    if (number_[vertex] != kNone) {
      used_.push_back(static_cast<std::uint32_t>(vertex));
    }
  }
}

/// Adds the vertices. Returns whether most of them were mirrored.
bool GltfSurface::add_vertices(const GltfPrimitive& primitive, const GltfPlacement& placement) {
  const bool in_place = placement.skin == nullptr && is_identity(placement.X_WM);
  std::size_t mirrored = 0;
  for (const std::uint32_t vertex : used_) {
    Eigen::Vector3d p_WV = morphed(primitive, placement.weights, vertex);
    if (placement.skin != nullptr) {
      const Eigen::Affine3d X_WM = blend(document_, primitive, *placement.skin, vertex);
      p_WV = X_WM * p_WV;
      mirrored += mirrors(X_WM.linear()) ? 1 : 0;
    } else if (!in_place) {
      p_WV = placement.X_WM * p_WV;
    }
    if (!p_WV.allFinite()) {
      document_.fail(*primitive.where, "expected finite coordinates, got others for vertex " +
                                           std::to_string(vertex));
    }
    mesh_.vertices.push_back(p_WV);
  }
  return placement.skin != nullptr ? 2 * mirrored > used_.size() : mirrors(placement.X_WM.linear());
}

}  // namespace firstcontact::detail
