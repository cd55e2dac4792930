#include <firstcontact/geometry/point_cloud.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace firstcontact {

Shape make_point_cloud(std::vector<Eigen::Vector3d> points, double radius) {
  if (points.empty()) {
    throw std::invalid_argument("make_point_cloud: there are no points");
  }
  Mesh mesh{.vertices = std::move(points), .triangles = {}};
  mesh.triangles.reserve(mesh.vertices.size());
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const auto v = static_cast<std::uint32_t>(k);
    mesh.triangles.push_back({v, v, v});
  }
  return Shape(std::move(mesh), radius);
}

}  // namespace firstcontact
