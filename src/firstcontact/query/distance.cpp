#include <firstcontact/query/distance.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/box_pairs.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/containment.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {
namespace {

using detail::MovingPair;

/// Above the errors of gaps in single precision, in units.
constexpr double kDoubt = 0x1p-14;

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  ClosestFeatures closest;
  std::uint32_t triangle_A = 0;
  std::uint32_t triangle_B = 0;
};

/// Best-first over pairs of boxes by the lower bound of their distance.
Nearest find_nearest(const MovingPair& pair, const RelativeState& state,
                     detail::WorkspaceData& workspace, WorkCount& work) {
  const detail::BoxesAtInstant boxes(pair, state);
  auto& queue = workspace.nearest;
  const auto farther = [](const auto& x, const auto& y) { return x.first > y.first; };
  Nearest best;
  queue.assign(1, {0.0, {false, 0, 0, detail::root(pair.A()), detail::root(pair.B())}});
  while (!queue.empty() && queue.front().first < best.distance) {
    std::pop_heap(queue.begin(), queue.end(), farther);
    const detail::BoxPair item = queue.back().second;
    queue.pop_back();
    if (item.is_triangle_pair) {
      ++work.triangle_pairs;
      const TrianglePair triangles = pair.place(state, item.triangle_A, item.triangle_B);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      if (closest.distance < best.distance) {
        best = {closest.distance, closest, item.triangle_A, item.triangle_B};
      }
      continue;
    }
    ++work.node_groups;
    boxes.open(item.A, item.B, [&](const detail::BoxesAtInstant::Lane& lane) {
      double gap = lane.gap();
      // Many pairs may be nearly as close: of surfaces that lie flat.
      if (gap < best.distance && best.distance - gap < kDoubt * pair.unit()) {
        gap = lane.precise_gap();
      }
      if (!(gap >= best.distance)) {
        queue.emplace_back(gap, lane.inside());
        std::push_heap(queue.begin(), queue.end(), farther);
      }
    });
  }
  return best;
}

}  // namespace

DistanceResult distance(const ShapePair& shapes, double t, Workspace& workspace) {
  if (!(t >= 0.0 && t <= 1.0)) {
    throw std::invalid_argument("distance: t must lie in [0, 1], got " + std::to_string(t));
  }
  const FloatEnvironmentGuard guard;
  const auto& [A, B, motion] = shapes;
  motion.enter(t);
  const MovingPair pair(A.hierarchy(), B.hierarchy(), motion);
  const RelativeState state = motion.state(t);
  DistanceResult result;
  result.enclosure_error = A.enclosure_error() + B.enclosure_error();
  const detail::ContactFrame frame{A, B, pair, t, motion.origin(t)};
  const detail::Containment found = detail::find_containment(A, B, pair, state);
  if (found.inside == detail::Inside::yes) {
    result.closest = detail::make_contact(frame, state, found);
    return result;
  }
  const Nearest nearest = find_nearest(pair, state, workspace.data(), result.work);
  const double radii = A.radius() + B.radius();
  result.distance = std::max(0.0, nearest.distance - radii);
  result.lower_bound = found.inside == detail::Inside::unsure
                           ? 0.0
                           : std::max(0.0, nearest.distance - radii - pair.gap_error(state));
  result.closest =
      detail::make_contact(frame, state, nearest.triangle_A, nearest.triangle_B, nearest.closest);
  return result;
}

DistanceResult distance(const MovingShape& A, const MovingShape& B, double t,
                        Workspace& workspace) {
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    const FloatEnvironmentGuard guard;
    // Of the order of the rounding: the exact distance is asked for.
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
