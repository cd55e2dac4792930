#include <firstcontact/query/distance.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

/// Finds the nearest two triangles at one instant.
///
/// Best-first over pairs of boxes by a lower bound of their distance. Boxes that are long for their
/// distance have a weak one along the directions that the kernel knows. The direction between the
/// closest points found so far separates most of what is farther: where surfaces bulge towards each
/// other, all of it.
class NearestSearch {
 public:
  NearestSearch(const MovingPair& pair, const RelativeState& state,
                detail::WorkspaceData& workspace, WorkCount& work)
      : pair_(pair), state_(state), boxes_(pair, state), queue_(workspace.nearest), work_(work) {}

  Nearest run() {
    const detail::BoxPair whole{false, 0, 0, detail::root(pair_.A()), detail::root(pair_.B())};
    descend(whole);
    const auto farther = [](const auto& x, const auto& y) { return x.first > y.first; };
    queue_.assign(1, {0.0, whole});
    while (!queue_.empty() && queue_.front().first < best_.distance) {
      std::pop_heap(queue_.begin(), queue_.end(), farther);
      const detail::BoxPair item = queue_.back().second;
      queue_.pop_back();
      if (item.is_triangle_pair) {
        try_triangles(item);
        continue;
      }
      ++work_.node_groups;
      boxes_.open(item.A, item.B, [&](const detail::BoxesAtInstant::Lane& lane) {
        const double gap = bound(lane);
        if (!(gap >= best_.distance)) {
          queue_.emplace_back(gap, lane.inside());
          std::push_heap(queue_.begin(), queue_.end(), farther);
        }
      });
    }
    return best_;
  }

 private:
  /// To two triangles, always into the boxes that seem nearest.
  void descend(detail::BoxPair item) {
    while (!item.is_triangle_pair) {
      ++work_.node_groups;
      double least = std::numeric_limits<double>::infinity();
      const detail::NodeBoxes A = item.A;
      const detail::NodeBoxes B = item.B;
      boxes_.open(A, B, [&](const detail::BoxesAtInstant::Lane& lane) {
        if (lane.gap() < least) {
          least = lane.gap();
          item = lane.inside();
        }
      });
      if (!(least < std::numeric_limits<double>::infinity())) {
        return;
      }
    }
    try_triangles(item);
  }

  void try_triangles(const detail::BoxPair& item) {
    ++work_.triangle_pairs;
    const TrianglePair triangles = pair_.place(state_, item.triangle_A, item.triangle_B);
    const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
    if (closest.distance < best_.distance) {
      best_ = {closest.distance, closest, item.triangle_A, item.triangle_B};
      direction_ = (closest.p_B - closest.p_A).stableNormalized();
    }
  }

  [[nodiscard]] double bound(const detail::BoxesAtInstant::Lane& lane) const {
    double gap = lane.gap();
    if (!(gap < best_.distance) || !(best_.distance < std::numeric_limits<double>::infinity())) {
      return gap;
    }
    gap = std::max(gap, lane.gap_along(direction_));
    // Many pairs may be nearly as close: of surfaces that lie flat.
    if (gap < best_.distance && best_.distance - gap < kDoubt * pair_.unit()) {
      gap = std::max(gap, lane.precise_gap());
    }
    return gap;
  }

  const MovingPair& pair_;
  const RelativeState& state_;
  detail::BoxesAtInstant boxes_;
  std::vector<std::pair<double, detail::BoxPair>>& queue_;
  WorkCount& work_;
  Nearest best_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();  // [-]  Unit where A and B are apart.
};

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
  const Nearest nearest = NearestSearch(pair, state, workspace.data(), result.work).run();
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
