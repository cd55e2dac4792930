#include <firstcontact/query/detail/contact_search.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include <firstcontact/narrowphase/advance_deforming.h>
#include <firstcontact/narrowphase/separating_direction.h>
#include <firstcontact/query/detail/budget_watch.h>
#include <firstcontact/query/detail/glide_cover.h>

namespace firstcontact::detail {
namespace {

/// t + tau rounded down (T. J. Dekker's two-sum tells the direction), for t, tau >= 0.
double after(double t, double tau) {
  const double sum = t + tau;
  const double part = sum - t;
  const double error = (t - (sum - part)) + (tau - part);
  return error < 0.0 ? std::nextafter(sum, 0.0) : sum;
}

/// Below this ratio of squared lengths the direction between two closest points is worse than the
/// one that the features define.
constexpr double kNearlyCoinciding = 0x1p-40;

/// Opened pairs of triangles; a dozen times what most queries open.
constexpr std::size_t kMostRemembered = 256;

/// A group that is bounded along with another one may be due so many times later as a group alone
/// after the bodies were placed: it loses little by that, and saves more.
constexpr double kWindowsOfSecond = 8.0;

/// Groups that are bounded by one placement of the boxes before it is asked for a newer one, of
/// motions that place them for longer than others. Where very many pairs come near at once, what an
/// older one loses would open all of them.
constexpr std::uint64_t kManyAtOnce = 16;
constexpr double kOftenPlaced = 0x1p-9;

/// Pairs of triangles that came due and were then proven free for good. Beyond, the next ones are
/// expected to be so, too.
constexpr std::uint64_t kManyFreed = 256;

/// Pairs of boxes that are bounded once more in double precision, until it is known for how many
/// that is the end; and how many it may cost for one.
constexpr std::uint64_t kFewRepeated = 64;
constexpr std::uint64_t kRepeatedForOne = 4;

/// After so much work, much more than most searches take, it is asked whether surfaces glide.
constexpr std::uint64_t kLongSearch = 1000;

/// Pairs of triangles that gliding may leave to be followed one by one, or else a part of the time
/// is looked at; how much of it, and how often. Shorter parts of the search's time lead nowhere.
constexpr std::size_t kMostLeftByGlide = 4000;
constexpr double kShorterGlide = 0.25;
constexpr double kLongerGlide = 2.0;
constexpr int kGlideTrials = 7;
constexpr double kShortestGlide = 0x1p-16;

/// Steps of one pair of triangles in a row; a dozen times what most take.
constexpr int kPatience = 100;

constexpr std::uint32_t kNotRemembered = std::numeric_limits<std::uint32_t>::max();

/// [m^2]  Of the larger triangle, roughly.
double size2(const TrianglePair& pair) {
  return std::max((pair.A[1] - pair.A[0]).squaredNorm() + (pair.A[2] - pair.A[0]).squaredNorm(),
                  (pair.B[1] - pair.B[0]).squaredNorm() + (pair.B[2] - pair.B[0]).squaredNorm());
}

class Search {
 public:
  Search(const MovingPair& pair, double t_begin, double t_end, const SearchLimits& limits,
         WorkspaceData& workspace, WorkCount& work)
      : pair_(pair),
        t_begin_(t_begin),
        t_end_(t_end),
        t_last_(t_end),
        limits_(limits),
        queue_(workspace.queue),
        groups_(workspace.groups),
        triangle_pairs_(workspace.triangle_pairs),
        opened_(workspace.opened_pairs),
        workspace_(workspace),
        work_(work),
        steps_before_(work.node_groups + work.steps),
        patience_(std::min(limits.patience, kLongSearch)),
        watch_(limits.budget),
        frame_(pair.box_frame()),
        all_remembered_(limits.threshold + limits.tolerance >= limits.band),
        box_threshold_(limits.threshold + (all_remembered_ ? limits.tolerance : 0.0)),
        boxes_window_(pair.motion().boxes_window() * pair.unit() /
                      std::max(pair.speed_bound(), 1e-300)),
        // A quarter of the tolerance may be spent on the order of ties, a half on stopping early.
        tie_window_(0.25 * limits.tolerance / std::max(pair.speed_bound(), 1e-300)) {}

  PieceResult run() {
    opened_.clear();
    start(t_begin_);
    while (!queue_.empty() || !is_over()) {
      if (best_.contact && queue_.top().priority() >= best_.t - stop_window_) {
        break;
      }
      if (const UndecidedReason reason = spent(); reason != UndecidedReason::none) {
        return stopped(reason);
      }
      if (!best_.contact && steps() - steps_before_ > patience_) {
        if (patience_ == limits_.patience) {
          PieceResult result = stopped(UndecidedReason::none);
          result.impatient = true;
          return result;
        }
        patience_ = limits_.patience;
        if (all_remembered_ && may_glide()) {
          forget_opened();
          continue;
        }
      }
      const QueueItem item = queue_.top();
      if (!item.is_triangle_pair) {
        process_group(item.index);
      } else {
        queue_.pop();
        const TriangleEntry entry = triangle_pairs_[item.index];
        triangle_pairs_.release(item.index);
        follow_triangles(entry);
      }
      if (unresolved_) {
        return stopped(UndecidedReason::precision);
      }
      if (all_remembered_ && opened_.size() > kMostRemembered) {
        forget_opened();
      }
    }
    return answer();
  }

 private:
  void clear_queue() {
    queue_.clear();
    groups_.clear();
    triangle_pairs_.clear();
  }

  void start(double t) {
    clear_queue();
    bound(new_group(t, root(pair_.A()), root(pair_.B()), 0));
  }

  /// Many pairs come into the band together: they are sooner found again, by distance, than opened
  /// one by one. Goes on without them from what is proven.
  void forget_opened() {
    all_remembered_ = false;
    box_threshold_ = limits_.threshold;
    frame_t_ = std::numeric_limits<double>::quiet_NaN();  // The frame holds the threshold.
    const double t = proven_free();
    if (!glide_on(t)) {
      start(t);
    }
  }

  [[nodiscard]] bool may_glide() const {
    return limits_.A != nullptr &&
           GlideCover::of(pair_, *limits_.A, *limits_.B, proven_free()).has_value();
  }

  /// Goes on from t with the pairs of triangles that are not proven apart by their surfaces'
  /// gliding, for as long as these are few. False if they are not, or nothing glides.
  [[nodiscard]] bool glide_on(double t) {
    if (limits_.A != nullptr && !best_.contact) {
      if (const auto cover = GlideCover::of(pair_, *limits_.A, *limits_.B, t)) {
        double width = std::min(glide_width_, t_last_ - t);
        for (int trial = 0; trial < kGlideTrials && may_end_after(t, width); ++trial) {
          t_end_ = width < t_last_ - t ? t + width : t_last_;
          if (cover->find(t_end_, box_threshold_, kMostLeftByGlide, workspace_)) {
            glide_width_ = kLongerGlide * width;
            follow_left(t);
            return true;
          }
          width *= kShorterGlide;
        }
      }
    }
    t_end_ = t_last_;
    return false;
  }

  /// Whether a window from t on would be as short as the time that is left, or long enough.
  [[nodiscard]] bool may_end_after(double t, double width) const {
    return width >= t_last_ - t || width >= kShortestGlide * (t_last_ - t_begin_);
  }

  /// Starts with the pairs that gliding left.
  void follow_left(double t) {
    clear_queue();
    for (const IndexPair& left : workspace_.left_by_glide) {
      TriangleEntry entry;
      entry.key = t;
      entry.a = left.a;
      entry.b = left.b;
      entry.opened = kNotRemembered;
      push_triangles(entry);
    }
  }

  /// Whether nothing is left, in windows after this one neither.
  [[nodiscard]] bool is_over() {
    while (queue_.empty() && !best_.contact && t_end_ < t_last_) {
      const double t = t_end_;
      if (!glide_on(t)) {
        start(t);
      }
    }
    return queue_.empty();
  }

  void push_triangles(const TriangleEntry& entry) {
    const std::uint32_t index = triangle_pairs_.add();
    triangle_pairs_[index] = entry;
    queue_.push({entry.key, index, true});
  }

  /// No contact of a lane before this time is proven.
  static double due(const BoxGroup& group, LaneTime lane) {
    return after(group.base, static_cast<double>(lane.time()));
  }

  /// The group's place in the queue.
  [[nodiscard]] QueueItem item(std::uint32_t index) const {
    const BoxGroup& group = groups_[index];
    return {group.due - lag(group.level), index, false};
  }

  /// Each level comes a little earlier than the last, so that ties are searched depth-first.
  [[nodiscard]] double lag(std::uint32_t level) const {
    return std::min(tie_window_, static_cast<double>(level) * (tie_window_ / 64.0));
  }

  [[nodiscard]] std::uint64_t steps() const { return work_.node_groups + work_.steps; }

  [[nodiscard]] UndecidedReason spent() {
    return watch_.spent(
        steps(), queue_.size() * sizeof(QueueItem) + groups_.bytes() + triangle_pairs_.bytes());
  }

  /// All that is left is proven free before the least priority.
  [[nodiscard]] double proven_free() const {
    const double t = queue_.empty() ? t_end_ : queue_.top().priority();
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
      // Where the search began, a pair of boxes that is left is merely one that was not looked at.
      result.all_remembered = all_remembered_ && result.t > t_begin_;
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

  /// A group that the kernel is to bound: a new one, or again one of pairs that were well
  /// separated.
  struct Bounding {
    std::uint32_t index;
    double t;      // Until then all lanes are proven.
    int far_lane;  // Because of which it is bound again, or none.
  };
  static constexpr int kNew = -1;

  void process_group(std::uint32_t index) {
    const double t = groups_[index].due;
    if (is_far(groups_[index])) {
      bound(take_again(index));
      return;
    }
    const BoxPair inside = next_inside(groups_[index]);
    if (!inside.is_triangle_pair) {
      bound(take_inside(index, inside));
      return;
    }
    drop_next(index);
    TriangleEntry entry;
    entry.key = t;
    entry.a = inside.triangle_A;
    entry.b = inside.triangle_B;
    entry.opened = remember(entry);
    follow_triangles(entry);
  }

  static bool is_far(const BoxGroup& group) { return (group.far >> group.next.lane() & 1u) != 0; }

  /// What the earliest lane of a group holds.
  [[nodiscard]] BoxPair next_inside(const BoxGroup& group) const {
    const int lane = group.next.lane();
    return open_lane(pair_, group.node_a, group.node_b, lane, (group.larger_a >> lane & 1u) != 0,
                     (group.larger_b >> lane & 1u) != 0);
  }

  /// Takes the group at the top of the queue away, to be bound again.
  [[nodiscard]] Bounding take_again(std::uint32_t index) {
    queue_.pop();
    return {index, groups_[index].due, groups_[index].next.lane()};
  }

  /// Takes the boxes in the earliest lane of the group at the top of the queue.
  [[nodiscard]] Bounding take_inside(std::uint32_t index, const BoxPair& inside) {
    const double t = groups_[index].due;
    const unsigned level = groups_[index].level + 1u;
    drop_next(index);
    return new_group(t, inside.A, inside.B, level);
  }

  [[nodiscard]] Bounding new_group(double t, const NodeBoxes& a, const NodeBoxes& b,
                                   unsigned level) {
    const std::uint32_t index = groups_.add();
    BoxGroup& group = groups_[index];
    group.lanes = kNoTimes;
    group.base = t;
    group.node_a = a.node;
    group.node_b = b.node;
    group.live = lanes_of(a.used, b.used);
    group.level = static_cast<std::uint16_t>(std::min(level, 0xffffu));
    return {index, t, kNew};
  }

  /// Drops the earliest lane of the group at the top of the queue.
  void drop_next(std::uint32_t index) {
    BoxGroup& group = groups_[index];
    const int lane = group.next.lane();
    group.live = static_cast<std::uint16_t>(group.live & ~(1u << lane));
    if (group.live == 0) {
      queue_.pop();
      groups_.release(index);
    } else {
      group.next = drop(group.lanes, lane);
      group.due = due(group, group.next);
      queue_.replace_top(item(index));
    }
  }

  /// The place of a pair among those opened; none any more where these are too many.
  [[nodiscard]] std::uint32_t remember(const TriangleEntry& entry) {
    if (all_remembered_) {
      opened_.push_back({entry.a, entry.b, entry.key, 0.0});
    }
    return static_cast<std::uint32_t>(opened_.size() - (all_remembered_ ? 1 : 0));
  }

  /// Bounds a group at the time until which it is proven, and the next one along with it if that
  /// can be done at the same instant: two take less than twice the time of one. Queues both.
  void bound(const Bounding& first) {
    go_to(first.t);
    const std::optional<Bounding> second = take_after(first.t);
    const BoxGroup& group = groups_[first.index];
    BoxBounds bounds;
    if (!second) {
      pair_.bound(frame_, group.node_a, group.node_b, bounds);
      take(first, bounds);
      return;
    }
    const BoxGroup& other = groups_[second->index];
    BoxBounds other_bounds;
    pair_.bound(frame_, group.node_a, group.node_b, bounds, other.node_a, other.node_b,
                other_bounds);
    take(first, bounds);
    take(*second, other_bounds);
  }

  /// What comes next in the queue, if it is to be bounded and due soon after the bodies were
  /// placed. Not what is due as early as t: of ties one may turn out to be the contact.
  [[nodiscard]] std::optional<Bounding> take_after(double t) {
    if (queue_.empty() || queue_.top().is_triangle_pair) {
      return std::nullopt;
    }
    const std::uint32_t index = queue_.top().index;
    const BoxGroup& group = groups_[index];
    const double latest = std::min(horizon(), state_t_ + kWindowsOfSecond * boxes_window_);
    if (!(t < group.due && group.due < latest)) {
      return std::nullopt;
    }
    if (is_far(group)) {
      return take_again(index);
    }
    const BoxPair inside = next_inside(group);
    if (inside.is_triangle_pair) {
      return std::nullopt;
    }
    return take_inside(index, inside);
  }

  /// Whether boxes as they are placed may be bounded for a group that is proven until t.
  [[nodiscard]] bool serves(double t) const {
    const bool is_old = served_ >= kManyAtOnce && pair_.motion().boxes_window() > kOftenPlaced;
    const double window = is_old ? std::min(tie_window_, boxes_window_) : boxes_window_;
    return state_t_ <= t && t < state_t_ + window;
  }

  /// Places boxes at t, or a little before.
  void go_to(double t) {
    if (!serves(t)) {
      move_to(t);
    }
    if (frame_t_ != state_t_) {
      frame_t_ = state_t_;
      served_ = 0;
      pair_.place(state_, box_threshold_ + error_, frame_);
    }
    frame_.horizon = round_up(horizon() - state_t_);
  }

  /// Keeps the lanes of a group that are not free for good, and queues them.
  void take(const Bounding& bounding, BoxBounds& bounds) {
    ++work_.node_groups;
    ++served_;
    BoxGroup& group = groups_[bounding.index];
    unsigned live = group.live & bounds.live;
    const unsigned doubt =
        in_doubt(pair_.A().nodes[group.node_a], pair_.B().nodes[group.node_b], bounds);
    if ((live & doubt) != 0) {
      live &= ~bound_in_double(group, live & doubt, bounds);
    }
    if (!all_remembered_ && freed_ > kManyFreed) {
      live &= ~free_triangles(group, live, bounds);
    }
    if (live == 0) {
      groups_.release(bounding.index);
      return;
    }
    group.larger_a = bounds.larger_a;
    group.larger_b = bounds.larger_b;
    group.far = bounds.far;
    group.live = static_cast<std::uint16_t>(live);
    group.next = prove(group.lanes, bounds.time, below(group.base - state_t_), live);
    group.base = state_t_;
    group.due = due(group, group.next);
    // A step that does not take the pair further would repeat for ever: it is opened instead.
    if (bounding.far_lane != kNew && !(due(group, group.lanes[bounding.far_lane]) > bounding.t)) {
      group.far &= static_cast<std::uint16_t>(~(1u << bounding.far_lane));
    }
    queue_.push(item(bounding.index));
  }

  /// Bodies that graze each other come near in many pairs of triangles, most of which one step
  /// frees for good. It costs less to take it here, where the bodies are placed and the triangles
  /// are at hand, than when the pair is due. Returns the lanes that are done with, and improves
  /// the times of others.
  unsigned free_triangles(const BoxGroup& group, unsigned live, BoxBounds& bounds) {
    const HierarchyNode& a = pair_.A().nodes[group.node_a];
    const HierarchyNode& b = pair_.B().nodes[group.node_b];
    unsigned done = 0;
    for (unsigned lanes = live & lanes_of(a.leaves(), b.leaves()); lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      TriangleEntry entry;
      entry.a = a.child_triangle(k / HierarchyNode::kWidth);
      entry.b = b.child_triangle(k % HierarchyNode::kWidth);
      ++work_.triangle_pairs;
      ++work_.steps;
      const TrianglePair triangles = pair_.place(state_, entry.a, entry.b);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      if (closest.distance + error_ <= limits_.threshold + limits_.tolerance) {
        continue;  // Perhaps the contact: followed when it is due.
      }
      const double tau = step(entry, triangles, closest, state_t_);
      if (covered(state_t_, tau)) {
        done |= 1u << k;
      } else {
        bounds.time[k] = std::max(bounds.time[k], round_down(std::min(tau, 4.0)));
      }
    }
    return done;
  }

  /// Lanes in which double precision, and the corners of triangles in place of their boxes, may
  /// find more. Two triangles are as quickly tested themselves; a large one matters to many small
  /// boxes, unless it turned out not to.
  [[nodiscard]] unsigned in_doubt(const HierarchyNode& a, const HierarchyNode& b,
                                  const BoxBounds& bounds) const {
    const unsigned triangle_pairs = lanes_of(a.leaves(), b.leaves());
    const unsigned large_triangles = (lanes_of(a.leaves(), b.used()) & bounds.larger_a) |
                                     (lanes_of(a.used(), b.leaves()) & bounds.larger_b);
    const bool corners_help = repeated_ < kFewRepeated + kRepeatedForOne * worth_repeating_;
    const unsigned doubt =
        (bounds.unsure | (corners_help ? large_triangles : 0u)) & ~triangle_pairs;
    // The box of a triangle that deforms is thick: its axes are those that suited it at t = 0.
    return pair_.deforms() ? doubt | triangle_pairs : doubt;
  }

  /// Repeats lanes where single precision could not tell; returns those that are done with, and
  /// improves the times of others.
  unsigned bound_in_double(const BoxGroup& group, unsigned lanes, BoxBounds& bounds) {
    std::array<PlacedBox, HierarchyNode::kWidth> b;
    for (unsigned slots = (lanes | lanes >> 4 | lanes >> 8 | lanes >> 12) & 15u; slots != 0;
         slots &= slots - 1) {
      const int j = std::countr_zero(slots);
      b[j] = pair_.place_B(state_, {group.node_b, static_cast<std::uint32_t>(j)});
    }
    const double enough = 2.0 * (horizon() - state_t_);
    repeated_ += static_cast<std::uint64_t>(std::popcount(lanes));
    unsigned done = 0;
    PlacedBox a;
    int placed = -1;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      const int i = k / HierarchyNode::kWidth;
      if (i != placed) {
        a = pair_.place_A(state_, {group.node_a, static_cast<std::uint32_t>(i)});
        placed = i;
      }
      const double apart =
          pair_.time_apart(state_, a, b[k % HierarchyNode::kWidth], box_threshold_, error_, enough);
      worth_repeating_ += apart > 2.0 * static_cast<double>(bounds.time[k]) ? 1 : 0;
      if (covered(state_t_, apart)) {
        done |= 1u << k;
      } else {
        bounds.time[k] = std::max(bounds.time[k], round_down(std::min(apart, 4.0)));
      }
    }
    return done;
  }

  /// Places both bodies.
  void move_to(double t) {
    if (t == state_t_) {
      return;
    }
    state_t_ = t;
    state_ = pair_.motion().state(t);
    error_ = pair_.gap_error(state_);
  }

  /// Advances a pair of triangles until it is in contact, leaves the step, or another pair is due.
  void follow_triangles(TriangleEntry entry) {
    ++work_.triangle_pairs;
    const double due = queue_.empty() ? horizon() : queue_.top().priority() + tie_window_;
    double t = entry.key;
    int steps_left = kPatience;
    do {
      if (best_.contact && t >= best_.t) {
        return;  // Nothing of it is left before the contact.
      }
      ++work_.steps;
      move_to(t);
      const TrianglePair triangles = pair_.place(state_, entry.a, entry.b);
      const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
      if (entry.opened < opened_.size()) {
        opened_[entry.opened].t = t;
        opened_[entry.opened].distance = closest.distance;
      }
      const double apart = closest.distance + error_;
      if (apart <= limits_.threshold + 0.5 * limits_.tolerance) {
        if (limits_.lines == nullptr || limits_.asked >= limits_.tolerance ||
            !decide_precisely(entry, t)) {
          found(entry, t, limits_.threshold + limits_.tolerance - apart);
        }
        return;
      }
      const double tau = step(entry, triangles, closest, t);
      if (covered(t, tau)) {
        ++freed_;
        return;
      }
      const double next = after(t, tau);
      if (!(next > t)) {
        // Doubles cannot take the pair any further.
        if (limits_.lines != nullptr && decide_precisely(entry, t)) {
          return;
        }
        if (apart <= limits_.band) {
          found(entry, t, limits_.band - apart);
          return;
        }
        unresolved_ = true;
        break;
      }
      // A tiny gap lasts while triangles turn; double-doubles know a direction for that.
      if (--steps_left == 0 && limits_.lines != nullptr && decide_precisely(entry, t)) {
        return;
      }
      t = next;
    } while (t <= due && !exhausted());
    entry.key = t;
    push_triangles(entry);
  }

  /// Follows a pair of triangles to its contact or to the end, from t on, in double-double. False
  /// where that does not decide either.
  [[nodiscard]] bool decide_precisely(const TriangleEntry& entry, double t) {
    const LinearTriangles triangles = limits_.lines->triangles(entry.a, entry.b);
    const PreciseLinearContact precise =
        precise_linear_contact(triangles.A, triangles.B,
                               {.threshold = limits_.threshold,
                                .tolerance = limits_.asked,
                                .least_tolerance = limits_.tolerance,
                                .position_error = triangles.position_error + threshold_rounding(),
                                .t_begin = t});
    work_.steps += static_cast<std::uint64_t>(precise.steps);
    if (precise.verdict == PreciseLinearVerdict::unresolved) {
      return false;
    }
    if (precise.verdict == PreciseLinearVerdict::free || precise.t > t_end_) {
      ++freed_;
    } else {
      found(entry, precise.t, 0.0, precise.tolerance_used);
    }
    return true;
  }

  /// [m]  Of the sum of margin and radii.
  [[nodiscard]] double threshold_rounding() const {
    const bool is_exact = limits_.A == nullptr || limits_.A->radius() + limits_.B->radius() == 0.0;
    return is_exact ? 0.0 : 0x1p-52 * limits_.threshold;
  }

  [[nodiscard]] bool exhausted() const { return watch_.may_be_spent(steps()); }

  /// The longest certificate of the direction between the closest points and of the direction that
  /// the features define, which stays accurate when the points nearly coincide; should both fail,
  /// of any normal and any product of edges.
  [[nodiscard]] double step(const TriangleEntry& entry, const TrianglePair& triangles,
                            const ClosestFeatures& closest, double t) const {
    const Eigen::Vector3d d = closest.p_B - closest.p_A;
    double best = 0.0;
    const auto consider = [&](const Eigen::Vector3d& direction) {
      const double length = direction.norm();
      if (length > 0.0 && best <= horizon() - t) {
        best = std::max(best, step_along(entry, triangles, closest, direction / length));
      }
    };
    consider(d);
    if (d.squaredNorm() < kNearlyCoinciding * size2(triangles)) {
      const Eigen::Vector3d by_features = separating_direction(triangles, closest);
      consider(by_features.dot(d) < 0.0 ? Eigen::Vector3d(-by_features) : by_features);
    }
    if (!(best > 0.0)) {
      for_each_plane_normal(triangles, [&](const Eigen::Vector3d& n) {
        consider(n);
        consider(-n);
      });
    }
    return best;
  }

  [[nodiscard]] double step_along(const TriangleEntry& entry, const TrianglePair& triangles,
                                  const ClosestFeatures& closest, const Eigen::Vector3d& n) const {
    if (!pair_.deforms()) {
      return advance(state_, triangles, n, limits_.threshold, error_, horizon());
    }
    return advance_deforming(state_, triangles, pair_.rates(state_, entry.a, entry.b), closest, n,
                             limits_.threshold, error_, horizon());
  }

  /// @param slack              [m]  by which it is nearer than it has to be
  /// @param precise_tolerance  [m]  as of the result
  void found(const TriangleEntry& entry, double t, double slack, double precise_tolerance = 0.0) {
    if (best_.contact && best_.t <= t) {
      return;
    }
    best_.contact = true;
    best_.t = t;
    best_.triangle_A = entry.a;
    best_.triangle_B = entry.b;
    best_.precise_tolerance = precise_tolerance;
    // Stopping this much earlier keeps the pair within its tolerance.
    stop_window_ = std::max(0.0, slack) * (1.0 - 0x1p-20) / std::max(pair_.speed_bound(), 1e-300);
  }

  const MovingPair& pair_;
  double t_begin_;
  double t_end_;  // Of the window that is searched.
  double t_last_;
  const SearchLimits& limits_;
  SearchQueue& queue_;
  Pool<BoxGroup>& groups_;
  Pool<TriangleEntry>& triangle_pairs_;
  std::vector<OpenedPair>& opened_;
  WorkspaceData& workspace_;
  WorkCount& work_;
  std::uint64_t steps_before_;
  std::uint64_t patience_;  // Work until something is done about it.
  BudgetWatch watch_;
  double glide_width_ = std::numeric_limits<double>::infinity();  // Of the next window.
  double state_t_ = std::numeric_limits<double>::quiet_NaN();     // Of the next two.
  RelativeState state_;
  double error_ = 0.0;
  double frame_t_ = std::numeric_limits<double>::quiet_NaN();
  BoxFrame frame_;            // For boxes; pairs of triangles do without.
  std::uint64_t served_ = 0;  // Groups that were bounded in it.
  /// All pairs of triangles within the band at the contact are to be among those opened: boxes are
  /// then tested against threshold + tolerance, so that no pair of them that is left holds any.
  bool all_remembered_;
  double box_threshold_;
  double boxes_window_;
  double tie_window_;
  double stop_window_ = 0.0;
  std::uint64_t freed_ = 0;     // Pairs of triangles.
  std::uint64_t repeated_ = 0;  // Bounds in double precision.
  std::uint64_t worth_repeating_ = 0;
  bool unresolved_ = false;
  PieceResult best_;
};

}  // namespace

PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work) {
  return Search(pair, t_begin, t_end, limits, workspace, work).run();
}

}  // namespace firstcontact::detail
