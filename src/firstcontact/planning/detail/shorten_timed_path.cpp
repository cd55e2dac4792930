#include <firstcontact/planning/detail/shorten_timed_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <firstcontact/planning/detail/timed_edges.h>

namespace firstcontact::detail {
namespace {

constexpr double kLeastGain = 1e-4;      // [-]  Part of the time or way that a change is to save.
constexpr int kHalvings = 8;             // Of the time by which what comes after is earlier.
constexpr std::size_t kMostIdle = 25;    // Tries in a row without gain after which it ends, also
constexpr std::size_t kTriesOfIdle = 4;  // this part of all tries.

using Motion = std::vector<TimedPlace>;

class TimedShortcuts {
 public:
  /// @param path  without the rest at its goal
  TimedShortcuts(TimedEdges& edges, Motion path, TimedPlace end,
                 const std::function<bool()>& is_over)
      : edges_(edges), path_(std::move(path)), end_(std::move(end)), is_over_(is_over) {}

  Motion run(std::size_t tries, RandomNumbers& random) {
    const std::size_t most_idle = std::max(kMostIdle, tries / kTriesOfIdle);
    skip_places();
    hurry();
    std::size_t idle = 0;
    for (std::size_t k = 0; k < tries && idle < most_idle && !is_over_(); ++k) {
      idle = cut(random) ? 0 : idle + 1;
    }
    skip_places();
    hurry();
    if (path_.back().t < end_.t) {
      path_.push_back(end_);
    }
    return std::move(path_);
  }

 private:
  static std::ptrdiff_t at(std::size_t k) { return static_cast<std::ptrdiff_t>(k); }

  /// [s]  The least time from which the speeds allow an edge that begins at another one.
  [[nodiscard]] double arrival(const TimedPlace& from, const Configuration& to) const {
    const double time = edges_.travel_time(from.q, to);
    double t = from.t + time;
    while (t - from.t < time) {  // The sum was rounded down.
      t = std::nextafter(t, std::numeric_limits<double>::infinity());
    }
    return t;
  }

  /// Leads each place straight to a far one: halves the way ahead until an edge is free.
  void skip_places() {
    for (std::size_t from = 0; from + 2 < path_.size(); ++from) {
      for (std::size_t to = path_.size() - 1; to > from + 1 && !is_over_();
           to = from + (to - from) / 2) {
        if (lead(Motion(path_.begin(), path_.begin() + at(from + 1)),
                 Motion(path_.begin() + at(to), path_.end()))) {
          break;
        }
      }
    }
  }

  /// Takes each edge as fast as it may be.
  void hurry() {
    for (std::size_t k = 0; k + 1 < path_.size() && !is_over_(); ++k) {
      if (path_[k + 1].t - arrival(path_[k], path_[k + 1].q) <= kLeastGain * path_.back().t) {
        continue;
      }
      (void)lead(Motion(path_.begin(), path_.begin() + at(k + 1)),
                 Motion(path_.begin() + at(k + 1), path_.end()));
    }
  }

  /// Joins two random places of different edges.
  bool cut(RandomNumbers& random) {
    double first = path_.back().t * random.uniform();
    double second = path_.back().t * random.uniform();
    if (second < first) {
      std::swap(first, second);
    }
    const std::size_t from = edge_at(first);
    const std::size_t to = edge_at(second);
    if (from == to) {
      return false;
    }
    Motion before(path_.begin(), path_.begin() + at(from + 1));
    Motion after(path_.begin() + at(to + 1), path_.end());
    if (first > before.back().t) {
      before.push_back(place_on(from, first));
    }
    if (second < after.front().t) {
      after.insert(after.begin(), place_on(to, second));
    }
    return lead(before, after);
  }

  /// The number of the edge that is on its way at a time before the arrival.
  [[nodiscard]] std::size_t edge_at(double t) const {
    std::size_t edge = 0;
    while (edge + 2 < path_.size() && path_[edge + 1].t <= t) {
      ++edge;
    }
    return edge;
  }

  [[nodiscard]] TimedPlace place_on(std::size_t edge, double t) const {
    const TimedPlace& from = path_[edge];
    const TimedPlace& to = path_[edge + 1];
    return {edges_.space().interpolate(from.q, to.q, (t - from.t) / (to.t - from.t)), t};
  }

  /// Takes one edge from the last place before to the first place after, if it gains by that.
  ///
  /// @param after  with the times of the path; ends at the goal
  bool lead(const Motion& before, const Motion& after) {
    const double most = after.front().t - arrival(before.back(), after.front().q);
    std::optional<Motion> best = most > 0.0 ? proven(before, after, most) : std::nullopt;
    if (!best) {
      best = proven(before, after, 0.0);
      double high = std::max(most, 0.0);
      double low = 0.0;
      for (int k = 0; k < kHalvings && best && high > 0.0; ++k) {
        const double middle = 0.5 * (low + high);
        std::optional<Motion> earlier = proven(before, after, middle);
        (earlier ? low : high) = middle;
        if (earlier) {
          best = std::move(earlier);
        }
      }
    }
    if (!best || !gains(*best)) {
      return false;
    }
    path_ = *std::move(best);
    return true;
  }

  [[nodiscard]] bool gains(const Motion& other) const {
    const double arrives = path_.back().t;
    const double way = length(path_);
    return other.back().t <= arrives && length(other) <= way &&
           (other.back().t < (1.0 - kLeastGain) * arrives ||
            length(other) < (1.0 - kLeastGain) * way);
  }

  [[nodiscard]] double length(const Motion& motion) const {
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
      sum += edges_.space().distance(motion[k].q, motion[k + 1].q);
    }
    return sum;
  }

  /// The motion with an edge between two parts, of which the second one is earlier.
  ///
  /// @param earlier  [s]
  /// @returns        none where it is not proven
  std::optional<Motion> proven(const Motion& before, const Motion& after, double earlier) {
    Motion made = before;
    for (const TimedPlace& place : after) {
      const double t = std::max(place.t - earlier, arrival(made.back(), place.q));
      if (t > made.back().t || place.q != made.back().q) {  // Else a wait of no time.
        made.push_back({place.q, t});
      }
    }
    if (made.back().t > end_.t) {
      return std::nullopt;
    }
    // The piece of an edge before a new place ends there rounded: it is proven anew, too.
    for (std::size_t k = std::max<std::size_t>(before.size(), 2) - 2; k + 1 < made.size(); ++k) {
      if (is_over_() || !edges_.is_free(made[k], made[k + 1])) {
        return std::nullopt;
      }
    }
    const bool rests = made.back().t < end_.t;
    return !rests || edges_.is_free(made.back(), end_) ? std::optional(std::move(made))
                                                       : std::nullopt;
  }

  TimedEdges& edges_;
  Motion path_;
  TimedPlace end_;
  const std::function<bool()>& is_over_;
};

}  // namespace

void shorten_timed_path(TimedEdges& edges, std::vector<TimedPlace>& path, std::size_t tries,
                        RandomNumbers& random, const std::function<bool()>& is_over) {
  if (tries == 0) {
    return;
  }
  const TimedPlace end = path.back();
  while (path.size() > 2 && path[path.size() - 2].q == end.q) {
    path.pop_back();  // The rest at the goal follows from the arrival.
  }
  path = TimedShortcuts(edges, std::move(path), end, is_over).run(tries, random);
}

}  // namespace firstcontact::detail
