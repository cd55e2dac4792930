#include <firstcontact/geometry/mass_properties.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/detail/thick_hull.h>
#include <firstcontact/geometry/detail/vertex_components.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/math/float_environment.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

/// [-]  Part of its size by which rounding may move corners of a flat hull out of their plane.
constexpr double kFlat = 1e-9;

[[noreturn]] void refuse(const std::string& what, const std::string& mend = "") {
  throw std::invalid_argument("mass_properties: " + what + "; " + mend +
                              "give mass, centre_of_mass and inertia");
}

/// Counts the edges that triangles do not run as often one way as the other.
std::size_t unbalanced_edges(const Mesh& mesh) {
  std::vector<std::pair<std::uint64_t, int>> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      runs.emplace_back(std::uint64_t{low} << 32 | high, t[k] == low ? 1 : -1);
    }
  }
  std::ranges::sort(runs);
  std::size_t count = 0;
  for (auto run = runs.begin(); run != runs.end();) {
    const std::uint64_t edge = run->first;
    int balance = 0;
    for (; run != runs.end() && run->first == edge; ++run) {
      balance += run->second;
    }
    const bool is_point = edge >> 32 == (edge & 0xffffffffu);
    count += balance != 0 && !is_point ? 1 : 0;
  }
  return count;
}

/// Finds the places that triangles use, each once.
std::vector<Vector3d> used_places(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  std::vector<Vector3d> places;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (!used[v]) {
        places.push_back(mesh.vertices[v]);
      }
      used[v] = true;
    }
  }
  return places;
}

MassProperties of_capsule(const Vector3d& begin, const Vector3d& end, double r) {
  const Vector3d axis = end - begin;
  const double length = axis.norm();
  const Vector3d u = length > 0.0 ? Vector3d(axis / length) : Vector3d::UnitZ();
  const double middle = std::numbers::pi * r * r * length;
  const double caps = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double along = (0.5 * middle + 0.4 * caps) * r * r;
  const double across = middle * (length * length / 12.0 + 0.25 * r * r) +
                        caps * (0.4 * r * r + 0.25 * length * length + 0.375 * length * r);
  return {middle + caps, begin + 0.5 * axis,
          across * Matrix3d::Identity() + (along - across) * u * u.transpose()};
}

/// The integrals over the space within a radius of a convex polygon.
///
/// @param polygon  a fan of triangles, as convex_hull() makes it
MassProperties of_plate(const Mesh& polygon, double r) {
  std::vector<std::uint32_t> corners{polygon.triangles[0][0], polygon.triangles[0][1]};
  for (const Triangle& t : polygon.triangles) {
    corners.push_back(t[2]);
  }
  // Fans from two corners share no diagonal, so that each edge has two triangles.
  const std::size_t n = corners.size();
  Mesh faces{.vertices = polygon.vertices, .triangles = {}};
  for (std::size_t k = 2; k < n; ++k) {
    faces.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    faces.triangles.push_back({corners[1], corners[(k + 1) % n], corners[k]});
  }
  return detail::thickened({}, faces, 1.0, r);
}

/// Twice the area of a triangle, along its normal.
Vector3d twice_area(const Mesh& mesh, const Triangle& t) {
  const Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

/// The integrals over the space within a radius of a flat hull.
///
/// Rounding may lift its corners out of their plane: then it has two sides.
///
/// @returns nothing for other meshes
std::optional<MassProperties> of_flat_hull(const Mesh& mesh, const std::vector<Vector3d>& places,
                                           double r) {
  Vector3d normal = Vector3d::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d along = twice_area(mesh, t);
    area += along.norm();
    normal = along.norm() > normal.norm() ? along : normal;
  }
  const Vector3d& origin = places.front();
  const Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
  std::vector<Vector3d> flat;
  for (const Vector3d& place : places) {
    const Vector3d p = R.transpose() * (place - origin);
    if (!(std::abs(p.z()) <= kFlat * std::sqrt(area))) {
      return std::nullopt;
    }
    flat.emplace_back(p.x(), p.y(), 0.0);
  }
  const Mesh polygon = convex_hull(flat);
  double of_hull = 0.0;
  for (const Triangle& t : polygon.triangles) {
    of_hull += twice_area(polygon, t).norm();
  }
  const double off = std::min(std::abs(area - of_hull), std::abs(area - 2.0 * of_hull));
  if (!(area > 0.0) || off > kFlat * area) {
    return std::nullopt;
  }
  const MassProperties plate = of_plate(polygon, r);
  return MassProperties{plate.volume, origin + R * plate.p_BC, R * plate.about_C * R.transpose()};
}

/// The tetrahedra from a point to the triangles: the sum of six times their signed volume, and a
/// bound of its rounding.
struct SixVolumes {
  double sum = 0.0;
  double error = 0.0;
};

/// Computes the corners of a triangle from the origin plus the offset. They are subtracted one
/// after the other: far away their sum would be rounded.
std::array<Vector3d, 3> corners(const Mesh& mesh, const Triangle& t, const Vector3d& origin,
                                const Vector3d& offset = Vector3d::Zero()) {
  return {mesh.vertices[t[0]] - origin - offset, mesh.vertices[t[1]] - origin - offset,
          mesh.vertices[t[2]] - origin - offset};
}

/// Computes the volume of each component of the mesh, at the number of its least vertex.
std::vector<SixVolumes> component_volumes(const Mesh& mesh, const Vector3d& origin,
                                          DisjointSets& components) {
  std::vector<SixVolumes> volumes(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, t, origin);
    SixVolumes& volume = volumes[components.root(t[0])];
    volume.sum += a.dot(b.cross(c));
    volume.error += a.norm() * b.norm() * c.norm();
  }
  // A bound of the number of roundings of a product and its term of the sum.
  const double roundings = static_cast<double>(mesh.triangles.size()) + 16.0;
  for (SixVolumes& volume : volumes) {
    volume.error *= roundings * 0x1p-52;
  }
  return volumes;
}

/// Computes the winding number of the other components around a vertex, by their solid angles (A.
/// Van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30,
/// 1983).
double winding_of_others(const Mesh& mesh, std::uint32_t vertex, DisjointSets& components) {
  double half_angle = 0.0;
  for (const Triangle& t : mesh.triangles) {
    if (components.root(t[0]) == vertex) {
      continue;
    }
    const auto [a, b, c] = corners(mesh, t, mesh.vertices[vertex]);
    half_angle +=
        std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                          b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return half_angle / (2.0 * std::numbers::pi);
}

/// Finds +1 where the triangles face outwards, -1 where they face inwards.
double facing(const Mesh& mesh, const Vector3d& origin) {
  DisjointSets components = detail::vertex_components(mesh);
  const std::vector<SixVolumes> volumes = component_volumes(mesh, origin, components);
  SixVolumes total;
  for (const SixVolumes& volume : volumes) {
    total.sum += volume.sum;
    total.error += volume.error;
  }
  if (!(std::abs(total.sum) > total.error)) {
    refuse("its triangles enclose no volume");
  }
  const double sign = total.sum > 0.0 ? 1.0 : -1.0;
  for (std::uint32_t v = 0; v < volumes.size(); ++v) {
    if (sign * volumes[v].sum < -volumes[v].error &&
        sign * winding_of_others(mesh, v, components) < 0.5) {
      refuse("the part of vertex " + std::to_string(v) +
                 " faces the other way than the rest and is no cavity in it",
             "reverse its triangles, or ");
    }
  }
  return sign;
}

/// Computes the integrals of 1 and x, and of x x^T, over tetrahedra with a common corner at the
/// origin. They are d/6, d/24 (a + b + c) and d/120 (aa^T + bb^T + cc^T + ss^T) with d = a . (b x
/// c), s = a + b + c.
MassProperties of_polyhedron(const Mesh& mesh, const Vector3d& origin, double sign) {
  double six_volume = 0.0;
  Vector3d first = Vector3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, t, origin);
    const double d = a.dot(b.cross(c));
    six_volume += d;
    first += d * (a + b + c);
  }
  const Vector3d p_OC = first / (4.0 * six_volume);
  // Repeated from the centre of mass, so that no large terms are subtracted.
  Matrix3d second = Matrix3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, t, origin, p_OC);
    const Vector3d s = a + b + c;
    second += a.dot(b.cross(c)) *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  second *= sign / 120.0;
  return {sign * six_volume / 6.0, origin + p_OC, second.trace() * Matrix3d::Identity() - second};
}

/// A solid of revolution about z, or an ellipsoid, from its integrals.
///
/// @param p_BC     [m]
/// @param moments  [m^2]  of inertia about C, by the volume
MassProperties of_moments(double volume, const Vector3d& p_BC, const Vector3d& moments) {
  return {volume, p_BC, (volume * moments).asDiagonal()};
}

/// The integrals over a cylinder, a cone or an ellipsoid.
MassProperties of_curved(const ConvexCore& core) {
  constexpr double kPi = std::numbers::pi;
  const Vector3d squares = core.size.cwiseAbs2();
  if (core.kind == ConvexKind::ellipsoid) {
    return of_moments(4.0 / 3.0 * kPi * core.size.prod(), core.origin,
                      (Vector3d::Constant(squares.sum()) - squares) / 5.0);
  }
  const double disc = kPi * squares.x();
  const double length = 2.0 * core.size.z();
  if (core.kind == ConvexKind::cylinder) {
    const double across = (3.0 * squares.x() + length * length) / 12.0;
    return of_moments(disc * length, core.origin, {across, across, 0.5 * squares.x()});
  }
  const double across = (12.0 * squares.x() + 3.0 * length * length) / 80.0;
  return of_moments(disc * length / 3.0, core.origin - 0.25 * length * Vector3d::UnitZ(),
                    {across, across, 0.3 * squares.x()});
}

}  // namespace

MassProperties mass_properties(const Shape& shape) {
  const FloatEnvironmentGuard guard;
  if (shape.is_curved() && shape.radius() == 0.0) {
    return of_curved(shape.convex_set()->core());
  }
  Mesh mesh = shape.mesh();
  weld(mesh);
  const std::vector<Vector3d> places = used_places(mesh);
  if (places.size() <= 2 && shape.radius() > 0.0) {
    return of_capsule(places.front(), places.back(), shape.radius());
  }
  if (shape.radius() > 0.0) {
    if (const std::optional<MassProperties> plate = of_flat_hull(mesh, places, shape.radius())) {
      return *plate;
    }
  }
  if (const std::size_t open = unbalanced_edges(mesh); open > 0) {
    refuse("it encloses no space: " + std::to_string(open) +
               " edges are open or join triangles that face opposite sides",
           "close the mesh, or ");
  }
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& place : places) {
    bounds.extend(place);
  }
  const Vector3d origin = bounds.center();
  const double sign = facing(mesh, origin);
  const MassProperties core = of_polyhedron(mesh, origin, sign);
  return shape.is_solid() && shape.radius() > 0.0 && detail::is_convex(mesh, sign)
             ? detail::thickened(core, mesh, sign, shape.radius())
             : core;
}

}  // namespace firstcontact
