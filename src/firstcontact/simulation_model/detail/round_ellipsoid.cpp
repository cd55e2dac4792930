#include <firstcontact/simulation_model/detail/round_ellipsoid.h>

#include <algorithm>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/convex_set.h>

namespace firstcontact::detail {

std::optional<RoundEllipsoid> round_ellipsoid_of(const Shape& shape) {
  if (!shape.is_curved() || shape.convex_set()->rounding() > 0.0 ||
      shape.convex_set()->core().kind != ConvexKind::ellipsoid) {
    return std::nullopt;
  }
  const ConvexCore& core = shape.convex_set()->core();
  double scale = 1.0;
  for (const Eigen::Vector3d& corner : shape.mesh().vertices) {
    scale = std::max(scale, (corner - core.origin).cwiseQuotient(core.size).norm());
  }
  return RoundEllipsoid{.centre_B = core.origin,
                        .radii = scale * core.size,
                        .sag = (scale - 1.0) * core.size.maxCoeff()};
}

}  // namespace firstcontact::detail
