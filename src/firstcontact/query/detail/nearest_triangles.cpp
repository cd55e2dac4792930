#include <firstcontact/query/detail/nearest_triangles.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/convex_leaf.h>

namespace firstcontact::detail {
namespace {

/// Above the errors of gaps in single precision, in units.
constexpr double kDoubt = 0x1p-14;

/// Searches pairs of boxes best-first by a lower bound of their distance.
///
/// Boxes that are long for their distance have a weak bound along the directions of the kernel. The
/// direction between the closest points found so far separates most farther boxes. Where surfaces
/// bulge towards each other, it separates all of them.
class NearestSearch {
 public:
  NearestSearch(const MovingPair& pair, const RelativeState& state, WorkspaceData& workspace,
                WorkCount& work, const NearestTrianglesOptions& options)
      : pair_(pair),
        state_(state),
        boxes_(pair, state),
        queue_(workspace.nearest),
        work_(work),
        options_(options),
        watch_(options.budget) {}

  NearestTriangles run() {
    const BoxPair whole{false, 0, 0, root(pair_.A()), root(pair_.B())};
    descend(whole);
    const auto farther = [](const auto& x, const auto& y) { return x.first > y.first; };
    queue_.assign(1, {0.0, whole});
    while (!queue_.empty() && queue_.front().first < enough()) {
      best_.stopped = watch_.spent(work_.node_groups + work_.triangle_pairs,
                                   queue_.size() * sizeof(queue_.front()));
      if (best_.stopped != UndecidedReason::none) {
        break;
      }
      std::pop_heap(queue_.begin(), queue_.end(), farther);
      const BoxPair item = queue_.back().second;
      queue_.pop_back();
      if (item.is_triangle_pair) {
        try_triangles(item);
        continue;
      }
      ++work_.node_groups;
      boxes_.open(item.A, item.B, [&](const BoxesAtInstant::Lane& lane) {
        const double gap = bound(lane);
        if (!(gap >= enough())) {
          queue_.emplace_back(gap, lane.inside());
          std::push_heap(queue_.begin(), queue_.end(), farther);
        }
      });
    }
    return best_;
  }

 private:
  /// [m]  The distance from which pairs do not matter.
  [[nodiscard]] double enough() const {
    const double nearest =
        options_.slack > 0.0 ? best_.distance * (1.0 - options_.slack) : best_.distance;
    return std::min(nearest, options_.within);
  }

  /// Goes down to two triangles, always into the boxes that seem nearest; ends where these are too
  /// far apart.
  void descend(BoxPair item) {
    while (!item.is_triangle_pair) {
      ++work_.node_groups;
      double least = std::numeric_limits<double>::infinity();
      const NodeBoxes A = item.A;
      const NodeBoxes B = item.B;
      boxes_.open(A, B, [&](const BoxesAtInstant::Lane& lane) {
        if (lane.gap() < least) {
          least = lane.gap();
          item = lane.inside();
        }
      });
      if (!(least < options_.within)) {
        return;
      }
    }
    try_triangles(item);
  }

  void try_triangles(const BoxPair& item) {
    ++work_.triangle_pairs;
    const ClosestFeatures closest = closest_of(item);
    if (closest.distance < best_.distance && closest.distance <= options_.within) {
      best_ = {closest.distance, closest, item.triangle_A, item.triangle_B, best_.stopped};
      direction_ = (closest.p_B - closest.p_A).stableNormalized();
    }
  }

  [[nodiscard]] ClosestFeatures closest_of(const BoxPair& item) const {
    if (pair_.is_convex()) {
      return closest_features(pair_, state_, item.triangle_A, item.triangle_B, enough());
    }
    const TrianglePair triangles = pair_.place(state_, item.triangle_A, item.triangle_B);
    return triangle_distance(triangles.A, triangles.B);
  }

  [[nodiscard]] double bound(const BoxesAtInstant::Lane& lane) const {
    double gap = lane.gap();
    const double most = enough();
    if (!(gap < most) || !(most < std::numeric_limits<double>::infinity())) {
      return gap;
    }
    if (best_.distance < std::numeric_limits<double>::infinity()) {
      gap = std::max(gap, lane.gap_along(direction_));
    }
    // Many pairs may be nearly as close, where surfaces lie flat on each other.
    if (gap < most && most - gap < kDoubt * pair_.unit()) {
      gap = std::max(gap, lane.precise_gap());
    }
    return gap;
  }

  const MovingPair& pair_;
  const RelativeState& state_;
  BoxesAtInstant boxes_;
  std::vector<std::pair<double, BoxPair>>& queue_;
  WorkCount& work_;
  const NearestTrianglesOptions& options_;
  BudgetWatch watch_;
  NearestTriangles best_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();  // [-]  Unit where A and B are apart.
};

}  // namespace

NearestTriangles nearest_triangles(const MovingPair& pair, const RelativeState& state,
                                   WorkspaceData& workspace, WorkCount& work,
                                   const NearestTrianglesOptions& options) {
  return NearestSearch(pair, state, workspace, work, options).run();
}

}  // namespace firstcontact::detail
