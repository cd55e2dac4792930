#include <firstcontact/query/distance.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/containment.h>
#include <firstcontact/query/detail/nearest_triangles.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {

namespace {

/// [m]  A lower bound of the distance of the sets within the triangles, without radii.
///
/// The search for the nearest points of convex sets finds points, and proves nothing about others.
/// The triangles around a curved set enclose it.
double distance_of_triangles(const Shape& A, const Shape& B, const PairMotion& motion,
                             const RelativeState& state, Workspace& workspace, WorkCount& work) {
  const Shape around_A = A.as_triangles();
  const Shape around_B = B.as_triangles();
  const detail::MovingPair pair(around_A, around_B, motion);
  return detail::nearest_triangles(pair, state, workspace.data(), work).distance -
         pair.gap_error(state);
}

}  // namespace

DistanceResult distance(const ShapePair& shapes, double t, Workspace& workspace) {
  if (!(t >= 0.0 && t <= 1.0)) {
    throw std::invalid_argument("distance: t must lie in [0, 1], got " + detail::shortest(t));
  }
  const FloatEnvironmentGuard guard;
  const auto& [A, B, motion] = shapes;
  motion.enter(t);
  const detail::MovingPair pair(A, B, motion);
  const RelativeState state = motion.state(t);
  DistanceResult result;
  result.enclosure_error = detail::enclosure_error(A, B);
  const detail::ContactFrame frame{A, B, pair, t, motion.origin(t)};
  const detail::Containment found = detail::find_containment(A, B, pair, state);
  if (found.inside == detail::Inside::yes) {
    result.closest = detail::make_contact(frame, state, found);
    return result;
  }
  const detail::NearestTriangles nearest =
      detail::nearest_triangles(pair, state, workspace.data(), result.work);
  const double radii = A.radius() + B.radius();
  result.distance = std::max(0.0, nearest.distance - radii);
  result.closest =
      detail::make_contact(frame, state, nearest.triangle_A, nearest.triangle_B, nearest.closest);
  if (pair.is_convex() && nearest.distance - radii <= pair.gap_error(state)) {
    result.distance = 0.0;  // Within rounding: the direction of the points is noise.
    result.closest->n_AB_W.reset();
  } else if (found.inside != detail::Inside::unsure) {
    const double proven = pair.is_convex()
                              ? distance_of_triangles(A, B, motion, state, workspace, result.work)
                              : nearest.distance - pair.gap_error(state);
    result.lower_bound = std::max(0.0, proven - radii);
  }
  return result;
}

DistanceResult distance(const MovingShape& A, const MovingShape& B, double t,
                        Workspace& workspace) {
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    const FloatEnvironmentGuard guard;
    // Near the rounding: the exact distance is computed.
    const double resolution =
        1e-14 * (first.shape.hierarchy().radius + second.shape.hierarchy().radius);
    ConstantRatePair motion = detail::motion_of(first, second, resolution);
    return distance({first.shape, second.shape, motion}, t, workspace);
  };
  if (detail::in_order(A, B)) {
    return ask(A, B);
  }
  DistanceResult result = ask(B, A);
  swap_bodies(*result.closest);
  return result;
}

}  // namespace firstcontact
