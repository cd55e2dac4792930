#include <firstcontact/separation/detail/inside_solid.h>

#include <array>
#include <cstddef>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {
namespace {

/// Rays without any symmetry; another one is needed where a ray passes an edge too closely.
constexpr std::array<std::array<double, 3>, 6> kRays = {{{0.4183, 0.7411, 0.5251},
                                                         {-0.6347, 0.3089, -0.7083},
                                                         {0.2213, -0.8737, 0.4331},
                                                         {-0.5119, -0.4271, 0.7451},
                                                         {0.7573, -0.2887, -0.5857},
                                                         {-0.1871, 0.5923, 0.7837}}};

/// The sign of an interval: -1, 0 or 1 where it is certain; 0 only for exactly zero.
std::optional<int> sign(const Interval& x) {
  if (x.lower() > 0.0) {
    return 1;
  }
  if (x.upper() < 0.0) {
    return -1;
  }
  return x == Interval(0.0) ? std::optional<int>(0) : std::nullopt;
}

/// The crossing of a triangle by the ray from the origin along `ray`: 1 leaving, -1 entering, 0 for
/// none.
std::optional<int> crossing(const std::array<IntervalVector3, 3>& a, const IntervalVector3& ray) {
  bool left = false;
  bool right = false;
  bool certain = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<int> side = sign(dot(ray, cross(a[k], a[(k + 1) % 3])));
    left = left || side == 1;
    right = right || side == -1;
    certain = certain && side && *side != 0;
  }
  if (left && right) {
    return 0;  // The line passes beside the triangle.
  }
  if (!certain) {
    return std::nullopt;
  }
  const std::optional<int> volume = sign(dot(a[0], cross(a[1], a[2])));
  if (!volume || *volume == 0) {
    return std::nullopt;
  }
  const int direction = left ? 1 : -1;
  return *volume == direction ? direction : 0;  // Otherwise the triangle lies behind.
}

std::optional<int> winding(const Mesh& mesh, const IntervalVector3& p, const IntervalVector3& ray) {
  int total = 0;
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      continue;
    }
    std::array<IntervalVector3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = enclose(mesh.vertices[t[k]]) - p;
    }
    const std::optional<int> met = crossing(corners, ray);
    if (!met) {
      return std::nullopt;
    }
    total += *met;
  }
  return total;
}

}  // namespace

std::optional<bool> is_inside(const Mesh& mesh, const IntervalVector3& p) {
  for (const auto& ray : kRays) {
    const IntervalVector3 direction{{Interval(ray[0]), Interval(ray[1]), Interval(ray[2])}};
    if (const std::optional<int> number = winding(mesh, p, direction)) {
      return *number != 0;
    }
  }
  return std::nullopt;
}

std::vector<Eigen::Vector3d> points_of_components(const Shape& shape) {
  if (shape.is_curved()) {
    return {shape.convex_set()->core().origin};
  }
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t v : shape.component_vertices()) {
    points.push_back(shape.mesh().vertices[shape.hierarchy().vertex_index[v]]);
  }
  return points;
}

}  // namespace firstcontact::detail
