#include <firstcontact/geometry/primitives.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/detail/enclosing_ring.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

void require(bool holds, const std::string& what, double got) {
  if (!(holds && std::isfinite(got))) {
    throw std::invalid_argument(what + ", got " + detail::shortest(got));
  }
}

bool is_size(double length) { return length >= kLeastSize && length <= kGreatestSize; }

detail::EnclosingRing make_ring(double radius, std::optional<double> enclosure_error) {
  const double asked = enclosure_error.value_or(1e-4 * radius);
  require(asked >= kLeastEnclosureError * radius,
          "enclosure_error must be at least 1e-8 of the radius", asked);
  return detail::enclosing_ring(radius, asked);
}

std::uint32_t number(std::size_t index) { return static_cast<std::uint32_t>(index); }

void add_ring(const detail::EnclosingRing& ring, double z, Mesh& mesh) {
  for (const Eigen::Vector2d& corner : ring.corners) {
    mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  }
}

/// Adds triangles from each edge of the n vertices that begin at `first` to the tip.
///
/// @param up  whether the ring turns to the left, seen from the side that the tip faces
void add_fan(std::size_t first, std::size_t n, std::size_t tip, bool up, Mesh& mesh) {
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t a = number(first + k);
    const std::uint32_t b = number(first + (k + 1) % n);
    mesh.triangles.push_back(up ? std::array{a, b, number(tip)} : std::array{b, a, number(tip)});
  }
}

}  // namespace

Shape make_sphere(double radius) {
  require(is_size(radius), "make_sphere: radius must be in 1e-60 ... 1e60", radius);
  return Shape({.vertices = {{0.0, 0.0, 0.0}}, .triangles = {{0, 0, 0}}}, Filling::surface, 0.0,
               ConvexSet::sphere(radius));
}

Shape make_capsule(double radius, double length) {
  require(is_size(radius), "make_capsule: radius must be in 1e-60 ... 1e60", radius);
  require(length == 0.0 || is_size(length), "make_capsule: length must be 0 or in 1e-60 ... 1e60",
          length);
  return Shape(
      {.vertices = {{0.0, 0.0, -0.5 * length}, {0.0, 0.0, 0.5 * length}}, .triangles = {{0, 1, 1}}},
      Filling::surface, 0.0, ConvexSet::capsule(radius, length));
}

Shape make_box(const Eigen::Vector3d& size, double radius) {
  for (const double length : size) {
    require(is_size(length), "make_box: size must be in 1e-60 ... 1e60", length);
  }
  require(radius == 0.0 || is_size(radius), "make_box: radius must be 0 or in 1e-60 ... 1e60",
          radius);
  Mesh mesh;
  for (unsigned k = 0; k < 8; ++k) {
    const auto side = [&](unsigned axis) { return (k >> axis & 1u) != 0 ? 0.5 : -0.5; };
    mesh.vertices.emplace_back(side(0) * size.x(), side(1) * size.y(), side(2) * size.z());
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return Shape(std::move(mesh), Filling::solid, 0.0, ConvexSet::box(size, radius));
}

Shape make_cylinder(double radius, double length, std::optional<double> enclosure_error) {
  require(is_size(radius), "make_cylinder: radius must be in 1e-60 ... 1e60", radius);
  require(is_size(length), "make_cylinder: length must be in 1e-60 ... 1e60", length);
  const FloatEnvironmentGuard guard;
  const detail::EnclosingRing ring = make_ring(radius, enclosure_error);
  const std::size_t n = ring.corners.size();
  Mesh mesh;
  add_ring(ring, -0.5 * length, mesh);
  add_ring(ring, 0.5 * length, mesh);
  mesh.vertices.emplace_back(0.0, 0.0, -0.5 * length);
  mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = (k + 1) % n;
    mesh.triangles.push_back({number(k), number(next), number(n + next)});
    mesh.triangles.push_back({number(k), number(n + next), number(n + k)});
  }
  add_fan(0, n, 2 * n, false, mesh);
  add_fan(n, n, 2 * n + 1, true, mesh);
  return Shape(std::move(mesh), Filling::solid, ring.excess, ConvexSet::cylinder(radius, length));
}

Shape make_cone(double radius, double length, std::optional<double> enclosure_error) {
  require(is_size(radius), "make_cone: radius must be in 1e-60 ... 1e60", radius);
  require(is_size(length), "make_cone: length must be in 1e-60 ... 1e60", length);
  const FloatEnvironmentGuard guard;
  const detail::EnclosingRing ring = make_ring(radius, enclosure_error);
  const std::size_t n = ring.corners.size();
  Mesh mesh;
  add_ring(ring, -0.5 * length, mesh);
  mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length);
  mesh.vertices.emplace_back(0.0, 0.0, -0.5 * length);
  add_fan(0, n, n, true, mesh);
  add_fan(0, n, n + 1, false, mesh);
  return Shape(std::move(mesh), Filling::solid, ring.excess, ConvexSet::cone(radius, length));
}

}  // namespace firstcontact
