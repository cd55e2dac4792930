#include <firstcontact/query/detail/contact_search.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <firstcontact/narrowphase/separating_direction.h>

namespace firstcontact::detail {
namespace {

/// A pair of boxes this far apart, relative to their radii, is bound again before it is opened.
constexpr double kFar = 0.15;
constexpr double kSizeRatio = 1.5;  // Beyond it only the larger box is opened.

class Search {
 public:
  Search(const MovingPair& pair, double t_begin, double t_end, const SearchLimits& limits,
         WorkspaceData& workspace, WorkCount& work)
      : pair_(pair),
        t_begin_(t_begin),
        t_end_(t_end),
        limits_(limits),
        queue_(workspace.queue),
        work_(work),
        // A quarter of the tolerance may be spent on the order of ties, a half on stopping early.
        tie_window_(0.25 * limits.tolerance / std::max(pair.speed_bound(), 1e-300)) {}

  PieceResult run() {
    queue_.clear();
    push({t_begin_, t_begin_, box_threshold(), 0.0, {}, {}, false, false});
    while (!queue_.empty()) {
      if (best_.contact && queue_.front().priority >= best_.t - stop_window_) {
        break;
      }
      if (const UndecidedReason reason = spent(); reason != UndecidedReason::none) {
        return stopped(reason);
      }
      SearchEntry entry = pop();
      if (is_triangle(pair_.A(), entry.a) && is_triangle(pair_.B(), entry.b)) {
        if (!follow_triangles(entry)) {
          return stopped(UndecidedReason::precision);
        }
      } else {
        open(entry);
      }
    }
    return answer();
  }

 private:
  /// Boxes must not drop a pair that may be held to half its start distance.
  [[nodiscard]] double box_threshold() const {
    return limits_.start_contacts == StartContacts::keep_half
               ? std::max(limits_.margin,
                          0.5 * (limits_.radii + limits_.margin + limits_.tolerance))
               : limits_.margin;
  }

  static bool later(const SearchEntry& x, const SearchEntry& y) { return x.priority > y.priority; }

  void push(const SearchEntry& entry) {
    queue_.push_back(entry);
    std::push_heap(queue_.begin(), queue_.end(), later);
  }

  SearchEntry pop() {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const SearchEntry entry = queue_.back();
    queue_.pop_back();
    return entry;
  }

  [[nodiscard]] UndecidedReason spent() {
    const WorkBudget& budget = limits_.budget;
    const std::uint64_t steps = work_.node_groups + work_.steps;
    if (steps >= budget.steps) {
      return UndecidedReason::work;
    }
    if (queue_.size() * sizeof(SearchEntry) > budget.memory) {
      return UndecidedReason::memory;
    }
    if (budget.stop.stop_requested()) {
      return UndecidedReason::cancelled;
    }
    constexpr std::uint64_t kClockInterval = 64;  // Reading the clock costs as much as a step.
    if (budget.deadline && steps >= next_clock_) {
      next_clock_ = steps + kClockInterval;
      if (std::chrono::steady_clock::now() >= *budget.deadline) {
        return UndecidedReason::deadline;
      }
    }
    return UndecidedReason::none;
  }

  /// All that is left is proven free before the least priority.
  [[nodiscard]] double proven_free() const {
    const double t = queue_.empty() ? t_end_ : queue_.front().priority;
    return std::max(t_begin_, best_.contact ? std::min(t, best_.t) : t);
  }

  [[nodiscard]] PieceResult stopped(UndecidedReason reason) const {
    PieceResult result = best_;
    result.reason = reason;
    result.t = proven_free();
    return result;
  }

  [[nodiscard]] PieceResult answer() const {
    PieceResult result = best_;
    if (best_.contact) {
      result.t = proven_free();
    } else {
      result.t = t_end_;
      result.finished = true;
    }
    return result;
  }

  [[nodiscard]] double horizon() const { return best_.contact ? best_.t : t_end_; }

  /// A time that a certificate reaches: dropped where it covers the rest, the end included.
  [[nodiscard]] bool covered(double t, double tau) const {
    return tau > 0.0 && (best_.contact ? t + tau > best_.t : t + tau * (1.0 - 0x1p-50) >= t_end_);
  }

  void open(const SearchEntry& entry) {
    const double t = entry.key;
    const RelativeState state = pair_.motion().state(t);
    const double error = pair_.gap_error(state);
    if (entry.far) {
      ++work_.node_groups;
      push_bound(entry, pair_.place_A(state, entry.a), pair_.place_B(state, entry.b), t, error,
                 0.0);
      return;
    }
    const PlacedBox a = pair_.place_A(state, entry.a);
    const PlacedBox b = pair_.place_B(state, entry.b);
    const bool a_opens = !is_triangle(pair_.A(), entry.a);
    const bool b_opens = !is_triangle(pair_.B(), entry.b);
    const bool only_a = a_opens && (!b_opens || a.radius > kSizeRatio * b.radius);
    const bool only_b = b_opens && !only_a && (!a_opens || b.radius > kSizeRatio * a.radius);
    open_children(entry, state, error, !only_b, !only_a);
  }

  void open_children(const SearchEntry& entry, const RelativeState& state, double error,
                     bool open_a, bool open_b) {
    ++work_.node_groups;
    const BoxChildren as = boxes_of(pair_.A(), entry.a, open_a);
    const BoxChildren bs = boxes_of(pair_.B(), entry.b, open_b);
    std::array<PlacedBox, 4> placed_b;
    for (int j = 0; j < bs.count; ++j) {
      placed_b[j] = pair_.place_B(state, bs.boxes[j]);
    }
    for (int i = 0; i < as.count; ++i) {
      const PlacedBox a = pair_.place_A(state, as.boxes[i]);
      for (int j = 0; j < bs.count; ++j) {
        SearchEntry child = entry;
        child.a = as.boxes[i];
        child.b = bs.boxes[j];
        push_bound(child, a, placed_b[j], entry.key, error, tie_window_ / 64.0);
      }
    }
  }

  static BoxChildren boxes_of(const Hierarchy& hierarchy, BoxId box, bool open) {
    if (open) {
      return children(hierarchy, box);
    }
    BoxChildren itself;
    itself.boxes[0] = box;
    itself.count = 1;
    return itself;
  }

  void push_bound(SearchEntry entry, const PlacedBox& a, const PlacedBox& b, double t, double error,
                  double lowering) {
    const BoxPairBound bound = pair_.bound(a, b, entry.threshold, error);
    if (covered(t, bound.time)) {
      return;
    }
    const double lag = std::min(tie_window_, entry.key - entry.priority + lowering);
    entry.key = std::max(entry.key, t + bound.time * (1.0 - 0x1p-50));
    entry.priority = entry.key - lag;
    // A step that no longer moves the key would repeat for ever: then the pair is opened.
    entry.far = bound.gap > kFar * (a.radius + b.radius) && entry.key > t;
    push(entry);
  }

  /// Advances a pair of triangles until it is in contact, leaves the step, or another pair is due.
  /// False where doubles cannot resolve the pair.
  bool follow_triangles(SearchEntry entry) {
    ++work_.triangle_pairs;
    const std::uint32_t ta = triangle(pair_.A(), entry.a);
    const std::uint32_t tb = triangle(pair_.B(), entry.b);
    check_start(entry, ta, tb);
    const double due = queue_.empty() ? horizon() : queue_.front().priority + tie_window_;
    double t = entry.key;
    do {
      ++work_.steps;
      const RelativeState state = pair_.motion().state(t);
      const double error = pair_.gap_error(state);
      const TrianglePair triangles = pair_.place(state, ta, tb);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      const double tolerance = tolerance_of(entry);
      if (closest.distance + error <= entry.threshold + 0.5 * tolerance) {
        found(entry, t, entry.threshold + tolerance - closest.distance - error);
        return true;
      }
      const double tau = step(state, triangles, closest, entry.threshold, error, t);
      if (covered(t, tau)) {
        return true;
      }
      const double next = t + tau * (1.0 - 0x1p-50);
      if (!(next > t)) {
        if (closest.distance + error <= entry.threshold + tolerance) {
          found(entry, t, entry.threshold + tolerance - closest.distance - error);
          return true;
        }
        entry.key = t;
        entry.priority = t;
        push(entry);
        return false;
      }
      t = next;
    } while (t <= due && !exhausted());
    entry.key = t;
    entry.priority = t;
    push(entry);
    return true;
  }

  [[nodiscard]] bool exhausted() const {
    return work_.node_groups + work_.steps >= limits_.budget.steps ||
           limits_.budget.stop.stop_requested() ||
           (limits_.budget.deadline && work_.node_groups + work_.steps >= next_clock_);
  }

  /// The longest certificate of the direction between the closest points and of the direction that
  /// the features define, which stays accurate when the points nearly coincide; should both fail,
  /// of any normal and any product of edges.
  [[nodiscard]] double step(const RelativeState& state, const TrianglePair& triangles,
                            const ClosestFeatures& closest, double threshold, double error,
                            double t) const {
    const Eigen::Vector3d d = closest.p_B - closest.p_A;
    double best = 0.0;
    const auto consider = [&](const Eigen::Vector3d& direction) {
      const double length = direction.norm();
      if (length > 0.0 && best < t_end_ - t) {
        const Eigen::Vector3d n = direction / length;
        best = std::max(best,
                        advance(pair_.motion(), state, triangles, n, threshold, error, t, t_end_));
      }
    };
    consider(d);
    const Eigen::Vector3d by_features = separating_direction(triangles, closest);
    consider(by_features.dot(d) < 0.0 ? Eigen::Vector3d(-by_features) : by_features);
    if (!(best > 0.0)) {
      for_each_plane_normal(triangles, [&](const Eigen::Vector3d& n) {
        consider(n);
        consider(-n);
      });
    }
    return best;
  }

  [[nodiscard]] double tolerance_of(const SearchEntry& entry) const {
    // A held pair must not count as in contact at its start distance.
    return entry.held_tolerance > 0.0 ? std::min(limits_.tolerance, entry.held_tolerance)
                                      : limits_.tolerance;
  }

  /// keep_half: a pair that starts within the band, but apart, is held to half its start distance.
  void check_start(SearchEntry& entry, std::uint32_t ta, std::uint32_t tb) const {
    if (limits_.start_contacts != StartContacts::keep_half || entry.start_checked) {
      return;
    }
    entry.start_checked = true;
    entry.threshold = limits_.margin;
    const RelativeState state = limits_.start.motion().state(0.0);
    const TrianglePair triangles = limits_.start.place(state, ta, tb);
    const double distance = triangle_distance(triangles.A, triangles.B).distance;
    const double error = limits_.start.gap_error(state);
    const double apart = distance - limits_.radii;
    if (apart > 16.0 * error && distance <= limits_.margin + limits_.tolerance) {
      entry.threshold = limits_.radii + 0.5 * apart;
      entry.held_tolerance = 0.25 * apart;
    }
  }

  void found(const SearchEntry& entry, double t, double slack) {
    if (best_.contact && best_.t <= t) {
      return;
    }
    best_.contact = true;
    best_.t = t;
    best_.a = entry.a;
    best_.b = entry.b;
    // Stopping this much earlier keeps the pair within its tolerance.
    stop_window_ = std::max(0.0, slack) * (1.0 - 0x1p-20) / std::max(pair_.speed_bound(), 1e-300);
  }

  const MovingPair& pair_;
  double t_begin_;
  double t_end_;
  const SearchLimits& limits_;
  std::vector<SearchEntry>& queue_;
  WorkCount& work_;
  double tie_window_;
  double stop_window_ = 0.0;
  std::uint64_t next_clock_ = 0;
  PieceResult best_;
};

}  // namespace

PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work) {
  return Search(pair, t_begin, t_end, limits, workspace, work).run();
}

}  // namespace firstcontact::detail
