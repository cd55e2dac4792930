#include "benchmarks/support/torus_knot.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

constexpr double kTube = 0.4;             // [m]
constexpr double kLengthPerGirth = 12.5;  // [-]  Length of the tube divided by its girth: triangles
                                          // become about equilateral.
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Computes the knot's point at u in [0, 2 pi].
Vector3d knot(double u) {
  const double r = 2.0 + std::cos(3.0 * u);
  return {r * std::cos(2.0 * u), r * std::sin(2.0 * u), std::sin(3.0 * u)};
}

/// Two unit normals of the knot at u; after one round both return to their first values.
struct Frame {
  Vector3d normal;
  Vector3d binormal;
};

Frame frame(double u) {
  constexpr double kStep = 1e-3;
  const Vector3d before = knot(u - kStep);
  const Vector3d after = knot(u + kStep);
  const Vector3d tangent = (after - before).normalized();
  const Vector3d bend = before + after - 2.0 * knot(u);
  const Vector3d binormal = tangent.cross(bend).normalized();
  return {binormal.cross(tangent), binormal};
}

}  // namespace

Mesh torus_knot(std::size_t triangles) {
  const auto count = static_cast<double>(triangles);
  const auto around =
      static_cast<std::uint32_t>(std::lround(std::sqrt(count / 2.0 / kLengthPerGirth)));
  const auto along = static_cast<std::uint32_t>(std::lround(count / 2.0 / around));
  Mesh mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    const double u = kTurn * i / along;
    const Vector3d centre = knot(u);
    const Frame f = frame(u);
    for (std::uint32_t j = 0; j < around; ++j) {
      const double v = kTurn * j / around;
      mesh.vertices.push_back(centre + kTube * (std::cos(v) * f.normal + std::sin(v) * f.binormal));
    }
  }
  for (std::uint32_t i = 0; i < along; ++i) {
    const std::uint32_t ring = i * around;
    const std::uint32_t next_ring = (i + 1) % along * around;
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t k = (j + 1) % around;
      mesh.triangles.push_back({ring + j, next_ring + j, ring + k});
      mesh.triangles.push_back({ring + k, next_ring + j, next_ring + k});
    }
  }
  return mesh;
}

}  // namespace firstcontact::benchmarks
