#include <firstcontact/geometry/shape_bounds.h>

#include <algorithm>
#include <bit>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A few rounded operations.
constexpr double kUp = 1.0 + 0x1p-44;
constexpr double kRounding = 0x1p-46;

/// Hulls of more vertices take more time to find and to visit than they save.
constexpr std::size_t kMostVertices = 4096;
constexpr std::size_t kMostCorners = 256;

double surface(const Vector3d& h) { return h.x() * h.y() + h.y() * h.z() + h.z() * h.x(); }

/// [m]  The rounding error of coordinates in the body frame.
double rounding_error(const Hierarchy& hierarchy) {
  return kRounding * (hierarchy.centre.norm() + hierarchy.radius);
}

/// [m]  Lists the places of all vertices at both ends of the step, from the centre.
std::vector<Vector3d> places_of(const Hierarchy& hierarchy) {
  std::vector<Vector3d> places = hierarchy.vertices;
  places.insert(places.end(), hierarchy.vertices_to.begin(), hierarchy.vertices_to.end());
  return places;
}

ShapeBounds box_around(const Hierarchy& hierarchy, const std::vector<Vector3d>& places,
                       const Matrix3d& axes) {
  Eigen::AlignedBox3d range;
  for (const Vector3d& place : places) {
    range.extend(axes * place);
  }
  ShapeBounds bounds;
  bounds.axes = axes;
  bounds.centre = hierarchy.centre + axes.transpose() * range.center();
  bounds.half_extents = (0.5 * range.sizes()).array() * kUp + rounding_error(hierarchy);
  return bounds;
}

PointRows corners_of_box(const ShapeBounds& box) {
  PointRows corners(8, 3);
  for (int k = 0; k < 8; ++k) {
    const Vector3d signs(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0);
    corners.row(k) = box.axes.transpose() * box.half_extents.cwiseProduct(signs);
  }
  return corners;
}

/// Finds the corners of the polytope.
///
/// @param to_centre  [m]  from the centre of the hierarchy to that of the box
PointRows corners_of(const std::vector<Vector3d>& places, const ShapeBounds& box,
                     const Vector3d& to_centre) {
  if (places.size() > kMostVertices) {
    return corners_of_box(box);
  }
  const std::vector<Vector3d> hull = convex_hull(places).vertices;
  if (hull.size() > kMostCorners) {
    return corners_of_box(box);
  }
  PointRows corners(hull.size(), 3);
  for (std::size_t k = 0; k < hull.size(); ++k) {
    corners.row(static_cast<Eigen::Index>(k)) = hull[k] - to_centre;
  }
  return corners;
}

}  // namespace

ShapeBounds shape_bounds(const Hierarchy& hierarchy) {
  const std::vector<Vector3d> places = places_of(hierarchy);
  ShapeBounds best = box_around(hierarchy, places, Matrix3d::Identity());
  const HierarchyNode& root = hierarchy.nodes.front();
  for (unsigned slots = root.used(); slots != 0; slots &= slots - 1) {
    ShapeBounds box = box_around(hierarchy, places, box_axes(root, std::countr_zero(slots)));
    if (surface(box.half_extents) < surface(best.half_extents)) {
      best = std::move(box);
    }
  }
  const Vector3d to_centre = best.centre - hierarchy.centre;
  for (const Vector3d& place : places) {
    best.reach = std::max(best.reach, (place - to_centre).norm());
  }
  best.error = rounding_error(hierarchy);
  best.reach = (best.reach + best.error) * kUp;
  best.corners = corners_of(places, best, to_centre);
  return best;
}

}  // namespace firstcontact
