#include <firstcontact/query/begins_inside.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/containment.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// A vertex of a shape in the world, by rounded arithmetic.
struct WorldPoint {
  Vector3d p_WP;
  double size = 0.0;  ///< [m]  The rounding error is at most 2^-48 of it.
  std::size_t shape = 0;
};

WorldPoint point_of(const ShapeAtStart& placed, std::size_t index) {
  const Hierarchy& hierarchy = placed.shape->hierarchy();
  const std::uint32_t vertex = placed.shape->component_vertices().front();
  const Vector3d p_SP = placed.shape->mesh().vertices[hierarchy.vertex_index[vertex]];
  const Eigen::Quaterniond R_WS = placed.X_WS.rotation.normalized();
  return {placed.X_WS.position + R_WS * p_SP, placed.X_WS.position.norm() + p_SP.norm(), index};
}

/// Whether a point is proven to lie in a surface.
bool is_inside(const WorldPoint& point, const ShapeAtStart& around) {
  const Hierarchy& hierarchy = around.shape->hierarchy();
  const Vector3d p_SP =
      around.X_WS.rotation.normalized().conjugate() * Vector3d(point.p_WP - around.X_WS.position);
  // Each of two turns and three sums errs by less than 2^-48 of its terms.
  const double size =
      point.size + around.X_WS.position.norm() + hierarchy.centre.norm() + hierarchy.radius;
  return detail::winds_around(hierarchy, p_SP - hierarchy.centre, 0x1p-45 * size) ==
         detail::Inside::yes;
}

}  // namespace

std::vector<BeginsInside> find_begins_inside(std::span<const ShapeAtStart> shapes) {
  const FloatEnvironmentGuard guard;
  std::vector<WorldPoint> points;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    points.push_back(point_of(shapes[k], k));
  }
  std::sort(points.begin(), points.end(), [](const WorldPoint& a, const WorldPoint& b) {
    return a.p_WP.x() != b.p_WP.x() ? a.p_WP.x() < b.p_WP.x() : a.shape < b.shape;
  });
  std::vector<BeginsInside> found;
  for (std::size_t around = 0; around < shapes.size(); ++around) {
    const ShapeAtStart& placed = shapes[around];
    // Fewer triangles enclose no space.
    if (placed.shape->is_solid() || placed.shape->mesh().triangles.size() < 4) {
      continue;
    }
    const Hierarchy& hierarchy = placed.shape->hierarchy();
    const Vector3d centre =
        placed.X_WS.position + placed.X_WS.rotation.normalized() * hierarchy.centre;
    const auto first =
        std::lower_bound(points.begin(), points.end(), centre.x() - hierarchy.radius,
                         [](const WorldPoint& point, double x) { return point.p_WP.x() < x; });
    const std::size_t begin = found.size();
    for (auto at = first; at != points.end() && at->p_WP.x() <= centre.x() + hierarchy.radius;
         ++at) {
      const bool is_near = (at->p_WP - centre).squaredNorm() <= hierarchy.radius * hierarchy.radius;
      if (is_near && at->shape != around && is_inside(*at, placed)) {
        found.push_back({at->shape, around});
      }
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(begin), found.end(),
              [](const BeginsInside& a, const BeginsInside& b) { return a.inside < b.inside; });
  }
  return found;
}

}  // namespace firstcontact
