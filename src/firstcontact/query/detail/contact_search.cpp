#include <firstcontact/query/detail/contact_search.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <firstcontact/narrowphase/separating_direction.h>

namespace firstcontact::detail {
namespace {

/// Lane 4 i + j for each used box i of one node and j of another.
std::uint16_t lanes_of(unsigned boxes_a, unsigned boxes_b) {
  // Bit i of A's boxes moves to bit 4 i, where the product puts B's.
  const unsigned spread =
      (boxes_a & 1u) | (boxes_a & 2u) << 3 | (boxes_a & 4u) << 6 | (boxes_a & 8u) << 9;
  return static_cast<std::uint16_t>(spread * boxes_b);
}

/// t + tau rounded down (T. J. Dekker's two-sum tells the direction), for t, tau >= 0.
double after(double t, double tau) {
  const double sum = t + tau;
  const double part = sum - t;
  const double error = (t - (sum - part)) + (tau - part);
  return error < 0.0 ? std::nextafter(sum, 0.0) : sum;
}

/// At most the value.
float round_down(double value) {
  return std::max(0.0f, static_cast<float>(value * (1.0 - 0x1p-22)));
}

class Search {
 public:
  Search(const MovingPair& pair, double t_begin, double t_end, const SearchLimits& limits,
         WorkspaceData& workspace, WorkCount& work)
      : pair_(pair),
        t_begin_(t_begin),
        t_end_(t_end),
        limits_(limits),
        queue_(workspace.queue),
        groups_(workspace.groups),
        triangle_pairs_(workspace.triangle_pairs),
        work_(work),
        frame_(pair.box_frame()),
        box_threshold_(box_threshold()),
        // A quarter of the tolerance may be spent on the order of ties, a half on stopping early.
        tie_window_(0.25 * limits.tolerance / std::max(pair.speed_bound(), 1e-300)) {}

  PieceResult run() {
    queue_.clear();
    groups_.clear();
    triangle_pairs_.clear();
    open(t_begin_, {0, pair_.A().nodes[0].used()}, {0, pair_.B().nodes[0].used()}, 0);
    while (!queue_.empty()) {
      if (best_.contact && queue_.front().priority >= best_.t - stop_window_) {
        break;
      }
      if (const UndecidedReason reason = spent(); reason != UndecidedReason::none) {
        return stopped(reason);
      }
      const QueueItem item = pop();
      if (!item.is_triangle_pair) {
        process_group(item.index);
      } else {
        const TriangleEntry entry = triangle_pairs_[item.index];
        triangle_pairs_.release(item.index);
        follow_triangles(entry);
      }
      if (unresolved_) {
        return stopped(UndecidedReason::precision);
      }
    }
    return answer();
  }

 private:
  /// A node and the boxes of it that take part.
  struct Boxes {
    std::uint32_t node = 0;
    unsigned used = 0;
  };

  /// Boxes must not drop a pair that may be held to half its start distance.
  [[nodiscard]] double box_threshold() const {
    return limits_.start_contacts == StartContacts::keep_half
               ? std::max(limits_.margin,
                          0.5 * (limits_.radii + limits_.margin + limits_.tolerance))
               : limits_.margin;
  }

  static bool later(const QueueItem& x, const QueueItem& y) { return x.priority > y.priority; }

  void push(const QueueItem& item) {
    queue_.push_back(item);
    std::push_heap(queue_.begin(), queue_.end(), later);
  }

  QueueItem pop() {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const QueueItem item = queue_.back();
    queue_.pop_back();
    return item;
  }

  void push_triangles(const TriangleEntry& entry) {
    push({entry.key, triangle_pairs_.add(entry), true});
  }

  /// Queues a group by its earliest live lane, or forgets it when none is left.
  void push_group(std::uint32_t index) {
    const BoxGroup& group = groups_[index];
    if (group.live == 0) {
      groups_.release(index);
      return;
    }
    push({key(group, earliest(group)) - lag(group.level), index, false});
  }

  static int earliest(const BoxGroup& group) {
    float least = std::numeric_limits<float>::infinity();
    int lane = 0;
    for (unsigned live = group.live; live != 0; live &= live - 1) {
      const int k = std::countr_zero(live);
      if (group.time[k] < least) {
        least = group.time[k];
        lane = k;
      }
    }
    return lane;
  }

  static double key(const BoxGroup& group, int lane) {
    return after(group.base, static_cast<double>(group.time[lane]));
  }

  /// Each level comes a little earlier than the last, so that ties are searched depth-first.
  [[nodiscard]] double lag(std::uint32_t level) const {
    return std::min(tie_window_, static_cast<double>(level) * (tie_window_ / 64.0));
  }

  [[nodiscard]] UndecidedReason spent() {
    const WorkBudget& budget = limits_.budget;
    const std::uint64_t steps = work_.node_groups + work_.steps;
    if (steps >= budget.steps) {
      return UndecidedReason::work;
    }
    if (queue_.size() * sizeof(QueueItem) + groups_.bytes() + triangle_pairs_.bytes() >
        budget.memory) {
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

  void process_group(std::uint32_t index) {
    const BoxGroup group = groups_[index];  // A copy: opening may move the pool.
    const int lane = earliest(group);
    const double t = key(group, lane);
    if (group.far >> lane & 1u) {
      bound_again(index, t);
      return;
    }
    groups_[index].live = static_cast<std::uint16_t>(group.live & ~(1u << lane));
    push_group(index);
    const HierarchyNode& a = pair_.A().nodes[group.node_a];
    const HierarchyNode& b = pair_.B().nodes[group.node_b];
    const int i = lane / HierarchyNode::kWidth;
    const int j = lane % HierarchyNode::kWidth;
    if (a.is_leaf(i) && b.is_leaf(j)) {
      follow_triangles({t, box_threshold_, 0.0, a.child_triangle(i), b.child_triangle(j), false});
      return;
    }
    const bool keep_a = a.is_leaf(i) || (!b.is_leaf(j) && (group.larger_b >> lane & 1u) != 0);
    const bool keep_b = b.is_leaf(j) || (!a.is_leaf(i) && (group.larger_a >> lane & 1u) != 0);
    open(t, opened(pair_.A(), group.node_a, i, keep_a), opened(pair_.B(), group.node_b, j, keep_b),
         group.level + 1);
  }

  static Boxes opened(const Hierarchy& hierarchy, std::uint32_t node, int slot, bool keep) {
    if (keep) {
      return {node, 1u << slot};
    }
    const std::uint32_t child = hierarchy.nodes[node].child_node(slot);
    return {child, hierarchy.nodes[child].used()};
  }

  /// Queues the pairs of boxes that may meet after t.
  void open(double t, const Boxes& a, const Boxes& b, std::uint32_t level) {
    BoxGroup group;
    group.node_a = a.node;
    group.node_b = b.node;
    group.level = level;
    group.live = lanes_of(a.used, b.used);
    bound(t, group);
    if (group.live != 0) {
      push_group(groups_.add(group));
    }
  }

  /// Takes a group of well separated pairs further instead of opening them.
  void bound_again(std::uint32_t index, double t) {
    BoxGroup& group = groups_[index];
    const BoxGroup before = group;
    bound(t, group);
    const double elapsed = t - before.base;
    for (unsigned live = group.live; live != 0; live &= live - 1) {
      const int k = std::countr_zero(live);
      const float old = round_down(static_cast<double>(before.time[k]) - elapsed);
      group.time[k] = std::max(group.time[k], old);
    }
    push_group(index);
  }

  /// Bounds the live lanes of a group from t on; lanes that are free for good die.
  void bound(double t, BoxGroup& group) {
    ++work_.node_groups;
    const RelativeState state = pair_.motion().state(t);
    const double error = pair_.gap_error(state);
    pair_.place(state, box_threshold_ + error, horizon() - t, frame_);
    BoxBounds bounds;
    const HierarchyNode& a = pair_.A().nodes[group.node_a];
    const HierarchyNode& b = pair_.B().nodes[group.node_b];
    bound_boxes(frame_, a, b, bounds);
    std::copy(std::begin(bounds.time), std::end(bounds.time), group.time.begin());
    // Two triangles are as quickly tested themselves.
    const unsigned worthwhile = group.live & bounds.live & ~lanes_of(a.leaves(), b.leaves());
    for (unsigned unsure = bounds.unsure & worthwhile; unsure != 0; unsure &= unsure - 1) {
      bound_in_double(t, state, error, std::countr_zero(unsure), group, bounds);
    }
    group.base = t;
    group.live &= bounds.live;
    group.larger_a = bounds.larger_a;
    group.larger_b = bounds.larger_b;
    group.far = 0;
    for (unsigned far = bounds.far & group.live; far != 0; far &= far - 1) {
      // A step that does not move the key would repeat for ever: then the pair is opened.
      const int k = std::countr_zero(far);
      group.far |= static_cast<std::uint16_t>(key(group, k) > t ? 1u << k : 0u);
    }
  }

  /// Repeats one lane where single precision could not tell.
  void bound_in_double(double t, const RelativeState& state, double error, int lane,
                       BoxGroup& group, BoxBounds& bounds) const {
    const BoxId a{group.node_a, static_cast<std::uint32_t>(lane / HierarchyNode::kWidth)};
    const BoxId b{group.node_b, static_cast<std::uint32_t>(lane % HierarchyNode::kWidth)};
    const BoxPairBound bound =
        pair_.bound(pair_.place_A(state, a), pair_.place_B(state, b), box_threshold_, error);
    const auto bit = static_cast<std::uint16_t>(1u << lane);
    if (covered(t, bound.time)) {
      bounds.live &= static_cast<std::uint16_t>(~bit);
      return;
    }
    group.time[lane] = std::max(group.time[lane], round_down(std::min(bound.time, 4.0)));
  }

  /// Advances a pair of triangles until it is in contact, leaves the step, or another pair is due.
  void follow_triangles(TriangleEntry entry) {
    ++work_.triangle_pairs;
    check_start(entry);
    const double due = queue_.empty() ? horizon() : queue_.front().priority + tie_window_;
    double t = entry.key;
    do {
      ++work_.steps;
      const RelativeState state = pair_.motion().state(t);
      const double error = pair_.gap_error(state);
      const TrianglePair triangles = pair_.place(state, entry.a, entry.b);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      const double tolerance = tolerance_of(entry);
      if (closest.distance + error <= entry.threshold + 0.5 * tolerance) {
        found(entry, t, entry.threshold + tolerance - closest.distance - error);
        return;
      }
      const double tau = step(state, triangles, closest, entry.threshold, error, t);
      if (covered(t, tau)) {
        return;
      }
      const double next = after(t, tau);
      if (!(next > t)) {
        if (closest.distance + error <= entry.threshold + tolerance) {
          found(entry, t, entry.threshold + tolerance - closest.distance - error);
          return;
        }
        unresolved_ = true;  // Doubles cannot take the pair any further.
        break;
      }
      t = next;
    } while (t <= due && !exhausted());
    entry.key = t;
    push_triangles(entry);
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

  [[nodiscard]] double tolerance_of(const TriangleEntry& entry) const {
    // A held pair must not count as in contact at its start distance.
    return entry.held_tolerance > 0.0 ? std::min(limits_.tolerance, entry.held_tolerance)
                                      : limits_.tolerance;
  }

  /// keep_half: a pair that starts within the band, but apart, is held to half its start distance.
  void check_start(TriangleEntry& entry) const {
    if (limits_.start_contacts != StartContacts::keep_half || entry.start_checked) {
      return;
    }
    entry.start_checked = true;
    entry.threshold = limits_.margin;
    const RelativeState state = limits_.start.motion().state(0.0);
    const TrianglePair triangles = limits_.start.place(state, entry.a, entry.b);
    const double distance = triangle_distance(triangles.A, triangles.B).distance;
    const double error = limits_.start.gap_error(state);
    const double apart = distance - limits_.radii;
    if (apart > 16.0 * error && distance <= limits_.margin + limits_.tolerance) {
      entry.threshold = limits_.radii + 0.5 * apart;
      entry.held_tolerance = 0.25 * apart;
    }
  }

  void found(const TriangleEntry& entry, double t, double slack) {
    if (best_.contact && best_.t <= t) {
      return;
    }
    best_.contact = true;
    best_.t = t;
    best_.triangle_A = entry.a;
    best_.triangle_B = entry.b;
    // Stopping this much earlier keeps the pair within its tolerance.
    stop_window_ = std::max(0.0, slack) * (1.0 - 0x1p-20) / std::max(pair_.speed_bound(), 1e-300);
  }

  const MovingPair& pair_;
  double t_begin_;
  double t_end_;
  const SearchLimits& limits_;
  std::vector<QueueItem>& queue_;
  Pool<BoxGroup>& groups_;
  Pool<TriangleEntry>& triangle_pairs_;
  WorkCount& work_;
  BoxFrame frame_;
  double box_threshold_;
  double tie_window_;
  double stop_window_ = 0.0;
  std::uint64_t next_clock_ = 0;
  bool unresolved_ = false;
  PieceResult best_;
};

}  // namespace

PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work) {
  return Search(pair, t_begin, t_end, limits, workspace, work).run();
}

}  // namespace firstcontact::detail
