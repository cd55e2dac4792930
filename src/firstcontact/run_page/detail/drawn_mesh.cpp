#include <firstcontact/run_page/detail/drawn_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr int kSides = 32;  // Number of sides around a ball or a capsule.
constexpr int kRings = 8;   // Number of rings of each half of a ball.

bool is_point(const std::array<std::uint32_t, 3>& triangle) {
  return triangle[0] == triangle[1] && triangle[0] == triangle[2];
}

/// The ends of a mesh that is one point or one edge, where a radius makes it a ball or a capsule.
std::optional<std::array<Vector3d, 2>> round_ends(const Shape& shape) {
  const Mesh& mesh = shape.mesh();
  if (!(shape.radius() > 0.0) || mesh.triangles.size() != 1) {
    return std::nullopt;
  }
  const auto [a, b, c] = mesh.triangles.front();
  if (a != b && a != c && b != c) {
    return std::nullopt;
  }
  return std::array{mesh.vertices[a], mesh.vertices[a == b ? c : b]};
}

void append(std::vector<float>& vertices, const Vector3d& place) {
  for (const double coordinate : place) {
    vertices.push_back(static_cast<float>(coordinate));
  }
}

/// Makes a capsule from circles around the axis, from one pole to the other.
DrawnMesh capsule(const std::array<Vector3d, 2>& ends, double radius) {
  DrawnMesh drawn;
  drawn.origin = 0.5 * (ends[0] + ends[1]);
  const Vector3d half = 0.5 * (ends[1] - ends[0]);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(
      Vector3d::UnitZ(), half.norm() > 0.0 ? half : Vector3d::UnitZ());
  for (int ring = 0; ring < 2 * (kRings + 1); ++ring) {
    const bool is_upper = ring > kRings;
    const double latitude =
        std::numbers::pi / 2 * ((is_upper ? ring - kRings - 1 : ring - kRings) / double(kRings));
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const Vector3d direction(std::cos(latitude) * std::cos(angle),
                               std::cos(latitude) * std::sin(angle), std::sin(latitude));
      append(drawn.vertices, (is_upper ? half : Vector3d(-half)) + radius * (turn * direction));
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < 2 * (kRings + 1); ++ring) {
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t next = (side + 1) % kSides;
      const std::uint32_t low = ring * kSides;
      const std::uint32_t high = low + kSides;
      drawn.corners.insert(drawn.corners.end(), {low + side, low + next, high + next});
      drawn.corners.insert(drawn.corners.end(), {low + side, high + next, high + side});
    }
  }
  return drawn;
}

}  // namespace

DrawnMesh drawn_mesh(const Shape& shape) {
  if (const auto ends = round_ends(shape)) {
    return capsule(*ends, shape.radius());
  }
  const Mesh& mesh = shape.mesh();
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  DrawnMesh drawn;
  drawn.origin = box.center();
  for (const Vector3d& vertex : mesh.vertices) {
    append(drawn.vertices, vertex - drawn.origin);
  }
  if (!std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_point)) {
    for (const auto& triangle : mesh.triangles) {
      drawn.corners.insert(drawn.corners.end(), triangle.begin(), triangle.end());
    }
  }
  return drawn;
}

}  // namespace firstcontact::detail
