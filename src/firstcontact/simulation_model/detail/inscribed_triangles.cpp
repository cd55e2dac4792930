#include <firstcontact/simulation_model/detail/inscribed_triangles.h>

#include <cmath>
#include <utility>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/convex_set.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Moves a corner of the triangles around a set onto it, towards its axis or centre.
Vector3d on_surface(const ConvexCore& core, const Vector3d& corner) {
  const Vector3d from = corner - core.origin;
  if (core.kind == ConvexKind::ellipsoid) {
    return core.origin + from / from.cwiseQuotient(core.size).norm();
  }
  const double across = std::hypot(from.x(), from.y());
  if (across == 0.0) {
    return corner;  // The tip, or the middle of an end.
  }
  const double factor = core.size.x() / across;
  return core.origin + Vector3d(factor * from.x(), factor * from.y(), from.z());
}

}  // namespace

Shape inscribed_triangles(const Shape& shape) {
  if (!shape.is_curved()) {
    return shape;
  }
  Mesh mesh = shape.mesh();
  for (Vector3d& corner : mesh.vertices) {
    corner = on_surface(shape.convex_set()->core(), corner);
  }
  return Shape(std::move(mesh), shape.radius(),
               shape.is_solid() ? Filling::solid : Filling::surface);
}

}  // namespace firstcontact::detail
