#include "query/shape_cases.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/height_map.h>
#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/primitives.h>

#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

using Eigen::Vector3d;
using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

Vector3<double> in_box(Rng& rng, double half) {
  const double x = uniform(rng, -half, half);
  const double y = uniform(rng, -half, half);
  return {x, y, uniform(rng, -half, half)};
}

double maybe_radius(Rng& rng) { return rng() % 2 == 0 ? 0.0 : uniform(rng, 0.001, 0.1); }

Vector3d eigen(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

std::vector<Vector3d> eigen(const std::vector<Vector3<double>>& vs) {
  std::vector<Vector3d> result;
  std::transform(vs.begin(), vs.end(), std::back_inserter(result),
                 [](const Vector3<double>& v) { return eigen(v); });
  return result;
}

Support hull_support(std::vector<Vector3d> points) {
  return [points = std::move(points)](const Vector3d& n) {
    return *std::max_element(
        points.begin(), points.end(),
        [&](const Vector3d& a, const Vector3d& b) { return a.dot(n) < b.dot(n); });
  };
}

/// A piece for each triangle.
std::vector<Support> triangle_pieces(const MovingSoup& soup) {
  std::vector<Support> pieces;
  for (const auto& t : soup.triangles) {
    pieces.push_back(hull_support(
        {eigen(soup.vertices[t[0]]), eigen(soup.vertices[t[1]]), eigen(soup.vertices[t[2]])}));
  }
  return pieces;
}

/// All triangles between points: with the inside of the hull, they have its first contacts.
MovingSoup all_triangles(std::vector<Vector3<double>> points) {
  MovingSoup soup;
  soup.vertices = std::move(points);
  const std::size_t n = soup.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        soup.triangles.push_back({i, j, k});
      }
    }
  }
  return soup;
}

ShapeCase sphere(Rng& rng) {
  MovingSoup soup;
  soup.vertices = {{}};
  soup.triangles = {{0, 0, 0}};
  soup.radius = uniform(rng, 0.05, 0.6);
  return {make_sphere(soup.radius), soup, triangle_pieces(soup), {}};
}

ShapeCase capsule(Rng& rng) {
  MovingSoup soup;
  const double length = rng() % 4 == 0 ? 0.0 : uniform(rng, 0.1, 1.5);
  soup.vertices = {{0, 0, -0.5 * length}, {0, 0, 0.5 * length}};
  soup.triangles = {{0, 1, 1}};
  soup.radius = uniform(rng, 0.05, 0.4);
  return {make_capsule(soup.radius, length), soup, triangle_pieces(soup), {}};
}

std::vector<Vector3<double>> box_corners(Rng& rng, Vector3d& size) {
  size = {uniform(rng, 0.05, 1.2), uniform(rng, 0.05, 1.2), uniform(rng, 0.05, 1.2)};
  std::vector<Vector3<double>> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners.push_back({((k & 1u) != 0 ? 0.5 : -0.5) * size.x(),
                       ((k & 2u) != 0 ? 0.5 : -0.5) * size.y(),
                       ((k & 4u) != 0 ? 0.5 : -0.5) * size.z()});
  }
  return corners;
}

/// The sides alone, each split by either diagonal or both.
MovingSoup box_sides(const std::vector<Vector3<double>>& corners) {
  MovingSoup soup;
  soup.vertices = corners;
  constexpr std::size_t kSides[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                        {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
  for (const auto& s : kSides) {
    soup.triangles.push_back({s[0], s[1], s[2]});
    soup.triangles.push_back({s[0], s[2], s[3]});
  }
  return soup;
}

ShapeCase box(Rng& rng) {
  Vector3d size;
  const auto corners = box_corners(rng, size);
  return {make_box(size), box_sides(corners), {hull_support(eigen(corners))}, corners};
}

ShapeCase solid_mesh(Rng& rng) {
  Vector3d size;
  const auto corners = box_corners(rng, size);
  MovingSoup soup = box_sides(corners);
  soup.radius = maybe_radius(rng);
  const Shape surface = to_shape(soup);
  return {Shape(surface.mesh(), soup.radius, Filling::solid),
          soup,
          {hull_support(eigen(corners))},
          corners};
}

ShapeCase surface_mesh(Rng& rng) {
  Vector3d size;
  MovingSoup soup = box_sides(box_corners(rng, size));
  soup.triangles.resize(6 + rng() % 7);
  soup.radius = maybe_radius(rng);
  return {to_shape(soup), soup, triangle_pieces(soup), {}};
}

ShapeCase hull(Rng& rng) {
  std::vector<Vector3<double>> points;
  const std::size_t count = 4 + rng() % 4;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back(in_box(rng, 0.6));
  }
  MovingSoup soup = all_triangles(points);
  soup.radius = maybe_radius(rng);
  return {
      make_convex_hull(eigen(points), soup.radius), soup, {hull_support(eigen(points))}, points};
}

ShapeCase cloud(Rng& rng) {
  MovingSoup soup;
  const std::size_t count = 1 + rng() % 30;
  for (std::size_t k = 0; k < count; ++k) {
    soup.vertices.push_back(in_box(rng, 0.6));
    soup.triangles.push_back({k, k, k});
  }
  soup.radius = maybe_radius(rng);
  return {make_point_cloud(eigen(soup.vertices), soup.radius), soup, triangle_pieces(soup), {}};
}

ShapeCase height_map(Rng& rng) {
  const std::size_t rows = 2 + rng() % 2;
  HeightMap map{.cell = {uniform(rng, 0.2, 0.5), uniform(rng, 0.2, 0.5)},
                .columns = 2 + rng() % 2,
                .heights = {}};
  MovingSoup soup;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < map.columns; ++k) {
      map.heights.push_back(uniform(rng, -0.2, 0.2));
      soup.vertices.push_back({static_cast<double>(k) * map.cell.x(),
                               static_cast<double>(i) * map.cell.y(), map.heights.back()});
    }
  }
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    for (std::size_t k = 0; k + 1 < map.columns; ++k) {
      const std::size_t a = i * map.columns + k;
      const std::size_t b = a + map.columns;
      soup.triangles.push_back({a, b + 1, a + 1});
      soup.triangles.push_back({a, b, b + 1});
    }
  }
  soup.radius = maybe_radius(rng);
  return {make_height_map(map, soup.radius), soup, triangle_pieces(soup), {}};
}

/// From 1e-4 to 1e-2 of the radius; or by default.
std::optional<double> maybe_error(Rng& rng, double radius) {
  return rng() % 2 == 0 ? std::optional<double>()
                        : radius * std::pow(10.0, uniform(rng, -4.0, -2.0));
}

Vector3d disc_point(const Vector3d& n, double radius) {
  const double length = std::hypot(n.x(), n.y());
  return length > 0.0 ? Vector3d(radius * n.x() / length, radius * n.y() / length, 0.0)
                      : Vector3d(radius, 0.0, 0.0);
}

ShapeCase cylinder(Rng& rng) {
  const double radius = uniform(rng, 0.1, 0.5);
  const double half = uniform(rng, 0.05, 0.7);
  const auto support = [=](const Vector3d& n) {
    return Vector3d(disc_point(n, radius) + Vector3d(0, 0, n.z() > 0.0 ? half : -half));
  };
  return {make_cylinder(radius, 2.0 * half, maybe_error(rng, radius)), {}, {support}, {}};
}

ShapeCase cone(Rng& rng) {
  const double radius = uniform(rng, 0.1, 0.5);
  const double half = uniform(rng, 0.05, 0.7);
  const auto support = [=](const Vector3d& n) {
    const Vector3d rim = disc_point(n, radius) + Vector3d(0, 0, -half);
    const Vector3d tip(0, 0, half);
    return rim.dot(n) > tip.dot(n) ? rim : tip;
  };
  return {make_cone(radius, 2.0 * half, maybe_error(rng, radius)), {}, {support}, {}};
}

ShapeCase ellipsoid(Rng& rng) {
  const double x = uniform(rng, 0.05, 0.6);
  const double y = uniform(rng, 0.05, 0.6);
  const Vector3d radii(x, y, uniform(rng, 0.05, 0.6));
  const auto support = [=](const Vector3d& n) {
    return Vector3d(radii.cwiseProduct(radii.cwiseProduct(n).normalized()));
  };
  return {make_ellipsoid(radii, 0.1 * radii.maxCoeff()), {}, {support}, {}};
}

Quaternion random_rotation(Rng& rng) {
  const Vector3<double> v = in_box(rng, 1.0);
  return {uniform(rng, -1.0, 1.0) + 1e-6, v.x, v.y, v.z};
}

}  // namespace

ShapeCase random_shape(ShapeKind kind, Rng& rng) {
  switch (kind) {
    case ShapeKind::sphere:
      return sphere(rng);
    case ShapeKind::capsule:
      return capsule(rng);
    case ShapeKind::box:
      return box(rng);
    case ShapeKind::convex_hull:
      return hull(rng);
    case ShapeKind::point_cloud:
      return cloud(rng);
    case ShapeKind::height_map:
      return height_map(rng);
    case ShapeKind::solid_mesh:
      return solid_mesh(rng);
    case ShapeKind::surface_mesh:
      return surface_mesh(rng);
    case ShapeKind::cylinder:
      return cylinder(rng);
    case ShapeKind::cone:
      return cone(rng);
    case ShapeKind::ellipsoid:
      break;
  }
  return ellipsoid(rng);
}

MotionInput random_course(Rng& rng, const Vector3<double>& from, const Vector3<double>& to) {
  MotionInput m;
  m.poses = {{from, random_rotation(rng)}};
  switch (rng() % 4) {
    case 0:
      break;  // At rest.
    case 1:
      m.kind = MotionKind::constant_velocity;
      m.translation = to - from;
      m.rotation_vector = in_box(rng, 4.0);
      break;
    case 2:
      m.kind = MotionKind::screw_between;
      m.poses.push_back({to, random_rotation(rng)});
      break;
    default:
      m.kind = MotionKind::waypoints;
      m.times = {0.1, uniform(rng, 0.2, 0.8), 1.0};
      m.poses.push_back({0.5 * (from + to) + in_box(rng, 0.5), random_rotation(rng)});
      m.poses.push_back({to, random_rotation(rng)});
  }
  return m;
}

}  // namespace firstcontact::oracle
