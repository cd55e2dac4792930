#include <firstcontact/query/distance.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/order.h>

namespace firstcontact {
namespace {

using detail::BoxChildren;
using detail::BoxId;
using detail::MovingPair;

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  ClosestFeatures closest;
  std::uint32_t triangle_A = 0;
  std::uint32_t triangle_B = 0;
};

/// Best-first over pairs of boxes by the lower bound of their distance.
Nearest find_nearest(const MovingPair& pair, const RelativeState& state,
                     detail::WorkspaceData& workspace, WorkCount& work) {
  auto& queue = workspace.nearest;
  const auto farther = [](const auto& x, const auto& y) { return x.first > y.first; };
  Nearest best;
  queue.assign(1, {0.0, {BoxId{}, BoxId{}}});
  while (!queue.empty() && queue.front().first < best.distance) {
    std::pop_heap(queue.begin(), queue.end(), farther);
    const auto [box_A, box_B] = queue.back().second;
    queue.pop_back();
    if (detail::is_triangle(pair.A(), box_A) && detail::is_triangle(pair.B(), box_B)) {
      ++work.triangle_pairs;
      const std::uint32_t ta = detail::triangle(pair.A(), box_A);
      const std::uint32_t tb = detail::triangle(pair.B(), box_B);
      const TrianglePair triangles = pair.place(state, ta, tb);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      if (closest.distance < best.distance) {
        best = {closest.distance, closest, ta, tb};
      }
      continue;
    }
    ++work.node_groups;
    const BoxChildren as = detail::children(pair.A(), box_A);
    const BoxChildren bs = detail::children(pair.B(), box_B);
    for (int i = 0; i < as.count; ++i) {
      const detail::PlacedBox a = pair.place_A(state, as.boxes[i]);
      for (int j = 0; j < bs.count; ++j) {
        const double gap = MovingPair::gap(a, pair.place_B(state, bs.boxes[j]));
        if (gap < best.distance) {
          queue.push_back({gap, {as.boxes[i], bs.boxes[j]}});
          std::push_heap(queue.begin(), queue.end(), farther);
        }
      }
    }
  }
  return best;
}

DistanceResult solve(const MovingShape& A, const MovingShape& B, double t,
                     detail::WorkspaceData& workspace) {
  detail::SharedPiece piece(A.X_WS, B.X_WS);
  while (piece.end() < t) {
    piece.next();
  }
  const Hierarchy& hA = A.shape.hierarchy();
  const Hierarchy& hB = B.shape.hierarchy();
  const double resolution = 1e-14 * (hA.radius + hB.radius);
  const RelativeMotion motion(A.X_WS.path(piece.index_A(), hA.centre),
                              B.X_WS.path(piece.index_B(), hB.centre), resolution);
  const MovingPair pair(hA, hB, motion);
  const RelativeState state = motion.state(t);
  DistanceResult result;
  const Nearest nearest = find_nearest(pair, state, workspace, result.work);
  const double radii = A.shape.radius() + B.shape.radius();
  result.distance = std::max(0.0, nearest.distance - radii);
  result.lower_bound = std::max(0.0, nearest.distance - radii - pair.gap_error(state));
  const ConstantRatePath& path = motion.A();
  const detail::ContactFrame frame{A.shape, B.shape, pair, t,
                                   (path.pivot(t) + path.precise_lever(t)).value()};
  result.closest =
      detail::make_contact(frame, state, nearest.triangle_A, nearest.triangle_B, nearest.closest);
  return result;
}

}  // namespace

DistanceResult distance(const MovingShape& A, const MovingShape& B, double t,
                        Workspace& workspace) {
  if (!(t >= 0.0 && t <= 1.0)) {
    throw std::invalid_argument("distance: t must lie in [0, 1], got " + std::to_string(t));
  }
  const FloatEnvironmentGuard guard;
  if (detail::in_order(A, B)) {
    return solve(A, B, t, workspace.data());
  }
  DistanceResult result = solve(B, A, t, workspace.data());
  detail::swap_bodies(*result.closest);
  return result;
}

}  // namespace firstcontact
