#include <firstcontact/scene/detail/thin_mass.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The different corners of a triangle.
std::vector<Vector3d> corners(const Mesh& mesh, std::array<std::uint32_t, 3> triangle) {
  std::ranges::sort(triangle);
  std::vector<Vector3d> places;
  for (auto v = triangle.begin(); v != std::unique(triangle.begin(), triangle.end()); ++v) {
    places.push_back(mesh.vertices[*v]);
  }
  return places;
}

double measure(const std::vector<Vector3d>& simplex) {
  switch (simplex.size()) {
    case 3:
      return 0.5 * (simplex[1] - simplex[0]).cross(simplex[2] - simplex[0]).norm();
    case 2:
      return (simplex[1] - simplex[0]).norm();
    default:
      return 1.0;
  }
}

/// The integral of x x^T over a simplex of n corners and of mass m.
///
/// It is m / (n (n + 1)) times the sum of v v^T over the corners v, and over their sum.
Matrix3d second_moment(const std::vector<Vector3d>& simplex, const Vector3d& origin, double mass) {
  const auto n = static_cast<double>(simplex.size());
  Matrix3d moment = Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& corner : simplex) {
    const Vector3d v = corner - origin;
    moment += v * v.transpose();
    sum += v;
  }
  return mass / (n * (n + 1.0)) * (moment + sum * sum.transpose());
}

Vector3d mean(const std::vector<Vector3d>& simplex) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& corner : simplex) {
    sum += corner;
  }
  return sum / static_cast<double>(simplex.size());
}

}  // namespace

ThinMass thin_mass(const Mesh& mesh) {
  std::vector<std::vector<Vector3d>> simplices;
  std::size_t most = 1;
  for (const auto& triangle : mesh.triangles) {
    simplices.push_back(corners(mesh, triangle));
    most = std::max(most, simplices.back().size());
  }
  std::erase_if(simplices, [most](const auto& simplex) { return simplex.size() < most; });
  // The origin is a point of the mesh, so that far from the world's origin no digits are lost.
  const Vector3d origin = simplices.front().front();
  ThinMass result;
  Vector3d first = Vector3d::Zero();
  for (const auto& simplex : simplices) {
    result.mass += measure(simplex);
    first += measure(simplex) * (mean(simplex) - origin);
  }
  result.p_BC = origin + (result.mass > 0.0 ? Vector3d(first / result.mass) : first);
  Matrix3d second = Matrix3d::Zero();
  for (const auto& simplex : simplices) {
    second += second_moment(simplex, result.p_BC, measure(simplex));
  }
  result.about_C = second.trace() * Matrix3d::Identity() - second;
  return result;
}

}  // namespace firstcontact::detail
