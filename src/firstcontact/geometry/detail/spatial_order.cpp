#include <firstcontact/geometry/detail/spatial_order.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include <tbb/parallel_sort.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Puts two zeros between neighbouring bits of a number below 2^21.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

/// Morton codes of points in a cube.
class MortonCode {
 public:
  MortonCode(const Vector3d& low, double size)
      : low_(low), scale_(size > 0.0 ? kCells / size : 0.0) {}

  std::uint64_t operator()(const Vector3d& p) const {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const double cell = std::min((p[k] - low_[k]) * scale_, kCells);
      code |= spread(static_cast<std::uint64_t>(cell)) << k;
    }
    return code;
  }

 private:
  static constexpr double kCells = (1u << 21) - 1u;

  Vector3d low_;
  double scale_;
};

std::vector<std::uint32_t> order_triangles(const Mesh& mesh) {
  Vector3d low = mesh.vertices[mesh.triangles[0][0]];
  Vector3d high = low;
  for (const auto& t : mesh.triangles) {
    low = low.cwiseMin(mesh.vertices[t[0]]);
    high = high.cwiseMax(mesh.vertices[t[0]]);
  }
  const MortonCode code(low, (high - low).maxCoeff());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(mesh.triangles.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = {code(mesh.vertices[mesh.triangles[i][0]]), static_cast<std::uint32_t>(i)};
  }
  tbb::parallel_sort(keys);
  std::vector<std::uint32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](const auto& key) { return key.second; });
  return order;
}

}  // namespace

SpatialOrder spatial_order(const Mesh& mesh) {
  constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();
  SpatialOrder sorted;
  sorted.triangle_index = order_triangles(mesh);
  sorted.mesh.vertices.reserve(mesh.vertices.size());
  sorted.vertex_index.reserve(mesh.vertices.size());
  sorted.mesh.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnseen);
  for (const std::uint32_t i : sorted.triangle_index) {
    std::array<std::uint32_t, 3> triangle = mesh.triangles[i];
    for (std::uint32_t& v : triangle) {
      if (number[v] == kUnseen) {
        number[v] = static_cast<std::uint32_t>(sorted.mesh.vertices.size());
        sorted.mesh.vertices.push_back(mesh.vertices[v]);
        sorted.vertex_index.push_back(v);
      }
      v = number[v];
    }
    sorted.mesh.triangles.push_back(triangle);
  }
  return sorted;
}

}  // namespace firstcontact::detail
