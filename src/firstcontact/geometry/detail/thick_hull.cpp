#include <firstcontact/geometry/detail/thick_hull.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [-]  Part of the size of a mesh by which rounding may bend an edge inwards.
constexpr double kRounding = 1e-12;

/// A triangle of no area has a zero normal.
Vector3d normal_of(const Mesh& mesh, std::size_t triangle, double sign) {
  const auto& t = mesh.triangles[triangle];
  const Vector3d& a = mesh.vertices[t[0]];
  return sign * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).stableNormalized();
}

/// The two triangles at each edge, by its vertices in rising order. The first one runs along the
/// edge from the lower vertex.
using Neighbours = std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::size_t, 2>>;

Neighbours neighbours_of(const Mesh& mesh) {
  Neighbours neighbours;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& t = mesh.triangles[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i];
      const std::uint32_t b = t[(i + 1) % 3];
      neighbours[std::minmax(a, b)][a < b ? 0 : 1] = k;
    }
  }
  return neighbours;
}

/// The integrals of 1, x and x x^T.
class Moments {
 public:
  /// Adds a piece by its integrals about a point p: of 1, y and y y^T with y = x - p.
  void add(const Vector3d& p, double volume, const Vector3d& first, const Matrix3d& second) {
    volume_ += volume;
    first_ += volume * p + first;
    second_ += volume * p * p.transpose() + p * first.transpose() + first * p.transpose() + second;
  }

  [[nodiscard]] MassProperties about_centre(const Vector3d& origin) const {
    const Vector3d p = first_ / volume_;
    const Matrix3d second = second_ - volume_ * p * p.transpose();
    return {volume_, origin + p, second.trace() * Matrix3d::Identity() - second};
  }

 private:
  double volume_ = 0.0;
  Vector3d first_ = Vector3d::Zero();
  Matrix3d second_ = Matrix3d::Zero();
};

/// The pieces around a polyhedron, one kind after the other.
class Layer {
 public:
  Layer(const Mesh& mesh, double sign, double radius, const Vector3d& origin)
      : mesh_(mesh), sign_(sign), r_(radius), origin_(origin) {}

  void add_to(Moments& moments) const {
    for (std::size_t k = 0; k < mesh_.triangles.size(); ++k) {
      add_prism(k, moments);
    }
    // For each corner: the solid angle of its normals, and their integral.
    const std::vector<double> angles = solid_angles();
    std::vector<Vector3d> sums(mesh_.vertices.size(), Vector3d::Zero());
    for (const auto& [edge, sides] : neighbours_of(mesh_)) {
      add_wedge(edge, sides, moments);
      add_normals(edge, sides, sums);
    }
    const double third = r_ * r_ * r_ / 3.0;
    for (std::size_t v = 0; v < angles.size(); ++v) {
      moments.add(at(static_cast<std::uint32_t>(v)), third * angles[v], 0.75 * r_ * third * sums[v],
                  Matrix3d::Zero());
    }
    // The sectors of all corners together are a ball.
    const double ball = 4.0 / 15.0 * std::numbers::pi * std::pow(r_, 5);
    moments.add(Vector3d::Zero(), 0.0, Vector3d::Zero(), ball * Matrix3d::Identity());
  }

 private:
  [[nodiscard]] Vector3d at(std::uint32_t vertex) const { return mesh_.vertices[vertex] - origin_; }
  [[nodiscard]] Vector3d normal(std::size_t triangle) const {
    return normal_of(mesh_, triangle, sign_);
  }

  /// A prism of height r on a triangle, about the middle of the triangle.
  void add_prism(std::size_t triangle, Moments& moments) const {
    const auto& t = mesh_.triangles[triangle];
    const Vector3d middle = (at(t[0]) + at(t[1]) + at(t[2])) / 3.0;
    const Vector3d a = at(t[0]) - middle;
    const Vector3d b = at(t[1]) - middle;
    const Vector3d c = at(t[2]) - middle;
    const Vector3d n = normal(triangle);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Matrix3d across =
        area / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose());
    const Matrix3d along = area * r_ * r_ * r_ / 3.0 * n * n.transpose();
    moments.add(middle, area * r_, 0.5 * area * r_ * r_ * n, r_ * across + along);
  }

  /// The angle between the normals at an edge.
  [[nodiscard]] double bend(const std::array<std::size_t, 2>& sides) const {
    const Vector3d n = normal(sides[0]);
    const Vector3d m = normal(sides[1]);
    return std::atan2(n.cross(m).norm(), n.dot(m));
  }

  /// A sector of a cylinder about an edge, between the normals of its sides, about its middle.
  void add_wedge(const std::pair<std::uint32_t, std::uint32_t>& edge,
                 const std::array<std::size_t, 2>& sides, Moments& moments) const {
    const double angle = bend(sides);
    const Vector3d way = at(edge.second) - at(edge.first);
    const double length = way.norm();
    if (!(angle > 0.0 && length > 0.0)) {
      return;
    }
    // Halfway between both normals, which may be opposite.
    const Vector3d n = normal(sides[0]);
    const Vector3d u =
        std::cos(0.5 * angle) * n + std::sin(0.5 * angle) * sign_ * (way / length).cross(n);
    const Vector3d v = u.cross(way / length);
    const double area = 0.5 * angle * r_ * r_;
    const double first = 2.0 / 3.0 * std::sin(0.5 * angle) * r_ * r_ * r_;
    const double fourth = std::pow(r_, 4) / 8.0;
    const Matrix3d across = fourth * ((angle + std::sin(angle)) * u * u.transpose() +
                                      (angle - std::sin(angle)) * v * v.transpose());
    moments.add(0.5 * (at(edge.first) + at(edge.second)), area * length, first * length * u,
                length * across + area * length / 12.0 * way * way.transpose());
  }

  /// The integral of the normals of a corner is half the sum of its edges' bends, each along the
  /// edge into the polyhedron's outside (J. H. Lambert's formula for the irradiance of a polygon).
  void add_normals(const std::pair<std::uint32_t, std::uint32_t>& edge,
                   const std::array<std::size_t, 2>& sides, std::vector<Vector3d>& sums) const {
    const Vector3d way = (at(edge.second) - at(edge.first)).stableNormalized();
    const Vector3d half = 0.5 * bend(sides) * way;
    sums[edge.first] -= half;
    sums[edge.second] += half;
  }

  /// The solid angle of the normals at a corner is what the angles of its faces lack of 2 pi.
  [[nodiscard]] std::vector<double> solid_angles() const {
    std::vector<double> angles(mesh_.vertices.size(), 0.0);  // 0 for vertices of no triangle.
    for (const auto& t : mesh_.triangles) {
      for (const std::uint32_t corner : t) {
        angles[corner] = 2.0 * std::numbers::pi;
      }
    }
    for (const auto& t : mesh_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d a = at(t[(i + 1) % 3]) - at(t[i]);
        const Vector3d b = at(t[(i + 2) % 3]) - at(t[i]);
        angles[t[i]] -= std::atan2(a.cross(b).norm(), a.dot(b));
      }
    }
    return angles;
  }

  const Mesh& mesh_;
  double sign_;
  double r_;  // [m]
  Vector3d origin_;
};

}  // namespace

bool is_convex(const Mesh& mesh, double sign) {
  Eigen::AlignedBox3d box;
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      box.extend(mesh.vertices[corner]);
      used[corner] = true;
    }
  }
  // One sphere of triangles, by Euler's formula; several components may overlap.
  const auto corners = static_cast<std::size_t>(std::ranges::count(used, true));
  const Neighbours neighbours = neighbours_of(mesh);
  if (2 * neighbours.size() != 3 * mesh.triangles.size() ||
      corners + mesh.triangles.size() != neighbours.size() + 2) {
    return false;
  }
  const double rounding = kRounding * box.diagonal().norm();
  for (const auto& [edge, sides] : neighbours) {
    const Vector3d n = normal_of(mesh, sides[0], sign);
    if (n.isZero()) {
      return false;
    }
    for (const std::uint32_t corner : mesh.triangles[sides[1]]) {
      if (n.dot(mesh.vertices[corner] - mesh.vertices[edge.first]) > rounding) {
        return false;
      }
    }
  }
  return true;
}

MassProperties thickened(const MassProperties& core, const Mesh& mesh, double sign, double radius) {
  Moments moments;
  const Matrix3d second =
      0.5 * core.about_C.trace() * Matrix3d::Identity() - core.about_C;  // Of y y^T.
  moments.add(Vector3d::Zero(), core.volume, Vector3d::Zero(), second);
  Layer(mesh, sign, radius, core.p_BC).add_to(moments);
  return moments.about_centre(core.p_BC);
}

}  // namespace firstcontact::detail
