/// @file
/// Collects vertices and polygons while a file is read.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// A mesh in the making. Indices are checked at the end, as faces may stand before vertices.
class MeshBuilder {
 public:
  /// Room for at most `count` items, of which no more can come than `bytes` are left.
  void reserve_vertices(std::uint64_t count, std::size_t bytes, std::size_t least_size) {
    mesh_.vertices.reserve(std::min<std::uint64_t>(count, bytes / least_size + 1));
  }
  void reserve_triangles(std::uint64_t count, std::size_t bytes, std::size_t least_size) {
    mesh_.triangles.reserve(std::min<std::uint64_t>(count, bytes / least_size + 1));
  }

  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size(); }

  /// False where the vertex would have no number.
  [[nodiscard]] bool add_vertex(const Eigen::Vector3d& p) {
    if (mesh_.vertices.size() == std::numeric_limits<std::uint32_t>::max()) {
      return false;
    }
    mesh_.vertices.push_back(p);
    return true;
  }

  /// Begins a polygon whose place in the file, a line or a byte, is `place`.
  void begin_polygon(std::size_t place) {
    place_ = place;
    corners_ = 0;
  }

  /// False for an index that no vertex can have.
  [[nodiscard]] bool add_corner(std::int64_t index) {
    if (index < 0 || index >= std::numeric_limits<std::uint32_t>::max()) {
      return false;
    }
    const auto corner = static_cast<std::uint32_t>(index);
    if (corner >= greatest_.index_end) {
      greatest_ = {corner + 1, place_};
    }
    if (corners_ >= 2) {
      mesh_.triangles.push_back({first_, previous_, corner});
    }
    if (corners_ == 0) {
      first_ = corner;
    }
    previous_ = corner;
    ++corners_;
    return true;
  }

  /// Ends the polygon: one corner is a point, two are an edge. Returns its number of corners.
  std::size_t end_polygon() {
    if (corners_ == 1 || corners_ == 2) {
      mesh_.triangles.push_back({first_, previous_, previous_});
    }
    return corners_;
  }

  /// One past the greatest index, and where it stands.
  struct Greatest {
    std::uint32_t index_end = 0;
    std::size_t place = 0;
  };
  [[nodiscard]] const Greatest& greatest() const { return greatest_; }
  [[nodiscard]] bool has_range_error() const { return greatest_.index_end > vertex_count(); }
  [[nodiscard]] bool is_empty() const { return mesh_.triangles.empty(); }

  [[nodiscard]] Mesh finish() {
    mesh_.vertices.shrink_to_fit();
    mesh_.triangles.shrink_to_fit();
    return std::move(mesh_);
  }

 private:
  Mesh mesh_;
  Greatest greatest_;
  std::size_t place_ = 0;
  std::size_t corners_ = 0;
  std::uint32_t first_ = 0;
  std::uint32_t previous_ = 0;
};

}  // namespace firstcontact::detail
