#include <firstcontact/query/detail/contact_search.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/detail/group_bounder.h>
#include <firstcontact/query/detail/group_queue.h>
#include <firstcontact/query/detail/screw_sliding_windows.h>
#include <firstcontact/query/detail/search_state.h>
#include <firstcontact/query/detail/triangle_follower.h>

namespace firstcontact::detail {
namespace {

/// Most opened pairs of triangles that are remembered; a dozen times what most queries open.
constexpr std::size_t kMostRemembered = 256;

/// Work after which the search tries screw sliding; more than most searches take.
constexpr std::uint64_t kLongSearch = 1000;

/// Displacement of the bodies in the first window that begins at a front, in thresholds; and the
/// factor by which each further window is longer.
constexpr double kFirstWay = 8.0;
constexpr double kLongerWindow = 4.0;

/// Takes the first entry of the queue again and again.
///
/// It bounds a group of boxes, opens the contents of one of its lanes, or follows a pair of
/// triangles.
class Search {
 public:
  Search(const MovingPair& pair, double t_begin, double t_end, const SearchLimits& limits,
         WorkspaceData& workspace, WorkCount& work)
      : state_(pair, t_begin, t_end, limits, workspace, work),
        triangles_(state_),
        groups_(state_, triangles_),
        windows_(state_),
        front_(limits.front),
        front_width_(kFirstWay * (limits.threshold + limits.tolerance) /
                     std::max(pair.speed_bound(), 1e-300)),
        steps_before_(work.node_groups + work.steps),
        patience_(may_slide() ? std::min(limits.patience, kLongSearch) : limits.patience) {}

  PieceResult run() {
    state_.workspace.opened_pairs.clear();
    start(state_.t_begin);
    while (!state_.queue.empty() || !is_over()) {
      if (state_.best.contact &&
          state_.queue.top().priority() >=
              state_.best.t - std::max(state_.stop_window, state_.limits.early)) {
        break;
      }
      if (const UndecidedReason reason = spent(); reason != UndecidedReason::none) {
        return stopped(reason);
      }
      if (!state_.best.contact && state_.steps() - steps_before_ > patience_) {
        if (patience_ == state_.limits.patience) {
          PieceResult result = stopped(UndecidedReason::none);
          result.impatient = true;
          return result;
        }
        patience_ = state_.limits.patience;
        if (state_.all_remembered && windows_.may_screw_sliding()) {
          forget_opened();
          continue;
        }
      }
      if (state_.queue.top().is_triangle_pair) {
        triangles_.follow(state_.queue.take_triangles());
      } else {
        process_group(state_.queue.top().index);
      }
      if (state_.unresolved) {
        return stopped(UndecidedReason::precision);
      }
      if (state_.all_remembered && state_.workspace.opened_pairs.size() > kMostRemembered) {
        forget_opened();
      }
    }
    return answer();
  }

 private:
  void start(double t) {
    state_.queue.clear();
    if (front_ != nullptr && start_at_front(t)) {
      return;
    }
    groups_.bound(state_.queue.new_group(t, root(state_.pair.A()), root(state_.pair.B()), 0));
  }

  /// Starts the search in a short window at the front.
  ///
  /// Most first contacts are early, and a search of a short window finds them among few pairs.
  /// Later windows are longer. It returns false where the front has too many pairs, and is not
  /// called again.
  bool start_at_front(double t) {
    const double end = t + front_width_;
    state_.t_end = end < state_.t_last ? end : state_.t_last;
    if (!(state_.t_end > t) || !groups_.bound_front(*front_, t)) {
      front_ = nullptr;
      state_.t_end = state_.t_last;
      return false;
    }
    front_width_ *= kLongerWindow;
    if (state_.all_remembered) {
      state_.all_remembered = false;
      state_.box_threshold = state_.limits.threshold;
      state_.instant.forget_boxes();
    }
    return true;
  }

  /// Forgets the opened pairs, and goes on without them from the proven time.
  ///
  /// Where many pairs come into the band together, a search by distance finds them sooner than
  /// opening them one by one.
  void forget_opened() {
    state_.all_remembered = false;
    state_.box_threshold = state_.limits.threshold;
    state_.instant.forget_boxes();
    const double t = state_.proven_free();
    if (!may_slide() || !windows_.screw_sliding_on(t)) {
      start(t);
    }
  }

  /// Whether screw sliding is possible: a pair with a front does not slide (find_close_by_front()).
  [[nodiscard]] bool may_slide() const { return state_.limits.front == nullptr; }

  /// Whether nothing is left, also in later windows.
  [[nodiscard]] bool is_over() {
    while (state_.queue.empty() && !state_.best.contact && state_.t_end < state_.t_last) {
      const double t = state_.t_end;
      if (!may_slide() || !windows_.screw_sliding_on(t)) {
        start(t);
      }
    }
    return state_.queue.empty();
  }

  [[nodiscard]] UndecidedReason spent() {
    return state_.watch.spent(state_.steps(), state_.queue.bytes());
  }

  [[nodiscard]] PieceResult stopped(UndecidedReason reason) const {
    PieceResult result = state_.best;
    result.reason = reason;
    result.t = state_.proven_free();
    return result;
  }

  [[nodiscard]] PieceResult answer() const {
    PieceResult result = state_.best;
    if (state_.best.contact) {
      result.t = state_.proven_free();
      result.t_upper = state_.limits.early > 0.0 ? state_.best.t : result.t;
      // Where the search began, a remaining pair of boxes is one that was not looked at.
      result.all_remembered = state_.all_remembered && result.t > state_.t_begin;
    } else {
      result.t = state_.t_end;
      result.finished = true;
    }
    return result;
  }

  /// Goes on with the group at the top of the queue.
  void process_group(std::uint32_t index) {
    const BoxGroup& group = state_.queue.group(index);
    const double t = group.due;
    if (GroupQueue::is_far(group)) {
      groups_.bound(state_.queue.take_again(index));
      return;
    }
    const BoxPair inside = state_.queue.next_inside(group);
    if (!inside.is_triangle_pair) {
      groups_.bound(state_.queue.take_inside(index, inside));
      return;
    }
    state_.queue.drop_next(index);
    TriangleEntry entry;
    entry.key = t;
    entry.a = inside.triangle_A;
    entry.b = inside.triangle_B;
    entry.opened = remember(entry);
    triangles_.follow(entry);
  }

  /// The place of a pair among those opened; none where these are too many.
  [[nodiscard]] std::uint32_t remember(const TriangleEntry& entry) {
    std::vector<OpenedPair>& opened = state_.workspace.opened_pairs;
    if (state_.all_remembered) {
      opened.push_back({entry.a, entry.b, entry.key, 0.0});
    }
    return static_cast<std::uint32_t>(opened.size() - (state_.all_remembered ? 1 : 0));
  }

  SearchState state_;
  TriangleFollower triangles_;
  GroupBounder groups_;
  ScrewSlidingWindows windows_;
  const BoxFront* front_;
  double front_width_;  // Width of the next window that begins at the front.
  std::uint64_t steps_before_;
  std::uint64_t patience_;  // Work until the search tries another method.
};

}  // namespace

PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work) {
  return Search(pair, t_begin, t_end, limits, workspace, work).run();
}

}  // namespace firstcontact::detail
