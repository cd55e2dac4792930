#include <firstcontact/simulation_model/detail/round_ellipsoid.h>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/convex_set.h>

namespace firstcontact::detail {

std::optional<RoundEllipsoid> round_ellipsoid_of(const Shape& shape) {
  if (!shape.is_curved() || shape.convex_set()->rounding() > 0.0 ||
      shape.convex_set()->core().kind != ConvexKind::ellipsoid) {
    return std::nullopt;
  }
  const ConvexCore& core = shape.convex_set()->core();
  return RoundEllipsoid{.centre_B = core.origin, .radii = core.size};
}

}  // namespace firstcontact::detail
