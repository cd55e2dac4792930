#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/interval.h>
#include <firstcontact/math/interval_vector.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

/// Poles at both ends of z, and rings of `sectors` vertices between them.
struct Globe {
  std::size_t sectors;
  std::size_t rings;  // Rings of faces: one more than rings of vertices.
};

/// Chooses the numbers of sectors and rings. A sphere of radius 1 is inside where the vertices have
/// the length 1 + pi^2 / n^2, roughly.
Globe globe_of(double relative_error) {
  const auto half = static_cast<std::size_t>(std::ceil(0.5 * kPi / std::sqrt(relative_error)));
  const std::size_t rings = std::max<std::size_t>(3, half);
  return {2 * rings, rings};
}

Mesh make_globe(const Globe& globe, const Vector3d& radii, double scale) {
  Mesh mesh;
  const auto add = [&](double x, double y, double z) {
    mesh.vertices.emplace_back(scale * radii.x() * x, scale * radii.y() * y, scale * radii.z() * z);
  };
  add(0.0, 0.0, -1.0);
  for (std::size_t i = 1; i < globe.rings; ++i) {
    const double polar = kPi * static_cast<double>(i) / static_cast<double>(globe.rings);
    for (std::size_t k = 0; k < globe.sectors; ++k) {
      const double angle = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(globe.sectors);
      add(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), -std::cos(polar));
    }
  }
  add(0.0, 0.0, 1.0);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  const auto at = [&](std::size_t ring, std::size_t k) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * globe.sectors + k % globe.sectors);
  };
  for (std::size_t k = 0; k < globe.sectors; ++k) {
    mesh.triangles.push_back({0, at(1, k + 1), at(1, k)});
  }
  for (std::size_t i = 1; i + 1 < globe.rings; ++i) {
    for (std::size_t k = 0; k < globe.sectors; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  for (std::size_t k = 0; k < globe.sectors; ++k) {
    mesh.triangles.push_back({at(globe.rings - 1, k), at(globe.rings - 1, k + 1), last});
  }
  return mesh;
}

/// Whether the plane of each triangle is proven to pass outside the ellipsoid. Then no point of the
/// surface is inside.
bool passes_outside(const Mesh& mesh, const Vector3d& radii) {
  const IntervalVector3 axes = enclose(radii);
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    const IntervalVector3 a = enclose(mesh.vertices[t[0]]);
    const IntervalVector3 n =
        cross(enclose(mesh.vertices[t[1]]) - a, enclose(mesh.vertices[t[2]]) - a);
    const Interval offset = dot(n, a);
    Interval extent2(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      extent2 = extent2 + sqr(n.c[k] * axes.c[k]);
    }
    return offset.lower() > 0.0 && sqr(offset).lower() >= extent2.upper();
  });
}

/// [-]  Estimates the factor by which the ellipsoid has to shrink until no plane cuts it.
double least_distance(const Mesh& mesh, const Vector3d& radii) {
  double least = 1.0;
  for (const auto& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices[t[0]];
    const Vector3d n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    least = std::min(least, n.dot(a) / n.cwiseProduct(radii).norm());
  }
  return least;
}

/// [m]  Bounds the distance of a vertex, and so of any point of a triangle, from the ellipsoid: v /
/// |v_k / r_k| is a point of it.
double excess_of(const Mesh& mesh, const Vector3d& radii) {
  double most = 0.0;
  for (const Vector3d& v : mesh.vertices) {
    Interval stretched2(0.0);
    Interval length2(0.0);
    for (int k = 0; k < 3; ++k) {
      stretched2 = stretched2 + sqr(Interval(v[k]) / Interval(radii[k]));
      length2 = length2 + sqr(Interval(v[k]));
    }
    const Interval beyond = Interval(1.0) - Interval(1.0) / sqrt(stretched2);
    most = std::max(most, (sqrt(length2) * beyond).upper());
  }
  return most;
}

void require(bool holds, const char* what, double got) {
  if (!(holds && std::isfinite(got))) {
    throw std::invalid_argument(std::string(what) + ", got " + detail::shortest(got));
  }
}

}  // namespace

Shape make_ellipsoid(const Vector3d& radii, std::optional<double> enclosure_error) {
  for (const double radius : radii) {
    require(radius >= kLeastSize && radius <= kGreatestSize,
            "make_ellipsoid: radii must be in 1e-60 ... 1e60", radius);
  }
  const FloatEnvironmentGuard guard;
  const double greatest = radii.maxCoeff();
  require(radii.minCoeff() >= kFlattestEllipsoid * greatest,
          "make_ellipsoid: the least radius must be at least 1e-30 of the greatest",
          radii.minCoeff());
  const double asked = enclosure_error.value_or(5e-3 * greatest);
  require(asked >= kLeastEllipsoidError * greatest,
          "make_ellipsoid: enclosure_error must be at least 2e-4 of the greatest radius", asked);
  // In units of a power of two near the greatest radius, so that nothing over- or underflows.
  int exponent = 0;
  (void)std::frexp(greatest, &exponent);
  const Vector3d unit_radii(std::ldexp(radii.x(), -exponent), std::ldexp(radii.y(), -exponent),
                            std::ldexp(radii.z(), -exponent));
  const Globe globe = globe_of(0.9 * asked / greatest);
  double scale = 1.0 / least_distance(make_globe(globe, unit_radii, 1.0), unit_radii);
  double growth = 0x1p-40;
  Mesh mesh = make_globe(globe, unit_radii, scale);
  while (!passes_outside(mesh, unit_radii)) {
    scale *= 1.0 + growth;
    growth *= 2.0;
    mesh = make_globe(globe, unit_radii, scale);
  }
  const double excess = std::ldexp(excess_of(mesh, unit_radii), exponent);
  for (Vector3d& v : mesh.vertices) {
    v = Vector3d(std::ldexp(v.x(), exponent), std::ldexp(v.y(), exponent),
                 std::ldexp(v.z(), exponent));
  }
  return Shape(std::move(mesh), Filling::solid, excess, ConvexSet::ellipsoid(radii));
}

}  // namespace firstcontact
