#include <firstcontact/retiming/blend_motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/line_profile.h>
#include <firstcontact/retiming/detail/motion_writer.h>

namespace firstcontact {
namespace {

using detail::LineLimits;

/// [-]  Distance of a blend from the path, by half of T (w - u).
constexpr double kDeviationByTurn = 3.0 / 16.0;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The blend at one waypoint, in the units of the edges.
struct BlendPlan {
  double before = 0.0;   // [-]
  double after = 0.0;    // [-]
  double seconds = 0.0;  // [s]  0 for a rest.

  [[nodiscard]] double rate_before() const { return seconds > 0.0 ? 2.0 * before / seconds : 0.0; }
  [[nodiscard]] double rate_after() const { return seconds > 0.0 ? 2.0 * after / seconds : 0.0; }
};

/// Chooses the lengths and the times of all blends.
class BlendPlanner {
 public:
  BlendPlanner(const WaypointPath& path, const std::vector<RateLimits>& limits,
               const std::vector<double>& longest, double share, double deviation)
      : path_(path), limits_(limits), longest_(longest), share_(share), deviation_(deviation) {
    for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
      lines_.push_back(detail::line_limits(path, edge, limits, share, true));
    }
    plan_.resize(path.waypoints.size());
    trial_ = plan_;
    for (std::size_t edge = 0; edge < lines_.size(); ++edge) {
      edge_seconds_.push_back(seconds_of(edge));
      total_ += edge_seconds_.back();
    }
  }

  /// Plans one blend for each waypoint; those of the ends are empty.
  std::vector<BlendPlan> run() {
    constexpr int kSweeps = 4;
    bool has_changed = true;
    for (int sweep = 0; sweep < kSweeps && has_changed; ++sweep) {
      has_changed = false;
      for (std::size_t at = 1; at + 1 < plan_.size(); ++at) {
        has_changed = improve(at) || has_changed;
      }
    }
    return std::move(plan_);
  }

  [[nodiscard]] const LineLimits& line(std::size_t edge) const { return lines_[edge]; }

 private:
  /// The blends of some waypoints in a row, and the time that they save.
  struct Change {
    std::size_t first = 0;
    std::vector<BlendPlan> blends = {};
    double gain = 0.0;  // [s]
  };

  /// Finds the best length of one blend while the others keep theirs.
  bool improve(std::size_t at) {
    constexpr std::array<double, 11> kShares{1.0,  0.75, 0.55, 0.4,  0.3, 0.22,
                                             0.16, 0.11, 0.07, 0.04, 0.0};
    const double longest = longest_[at - 1];
    const double in = lines_[at - 1].rate;
    const double out = lines_[at].rate;
    // Either as long in time at the highest rates, or the same share of both edges.
    const std::array<std::array<double, 2>, 2> kinds{
        {{in / std::max(in, out), out / std::max(in, out)}, {1.0, 1.0}}};
    Change best;
    for (const auto& kind : kinds) {
      for (const double part : kShares) {
        Change change =
            changed(at, shortest_blend(at, longest * part * kind[0], longest * part * kind[1]));
        if (change.gain > best.gain) {
          best = std::move(change);
        }
      }
    }
    constexpr double kWorthwhile = 1e-4;  // Relative gain.
    const bool is_worthwhile = best.gain > kWorthwhile * total_;
    take(best);
    return is_worthwhile;
  }

  /// The changes by one blend: itself, and those near it that have to be slower for it.
  Change changed(std::size_t at, const BlendPlan& blend) {
    trial_[at] = blend;
    std::size_t last = at;
    for (std::size_t edge = at - 1; edge < lines_.size(); ++edge) {
      if (slow_end(edge)) {
        last = std::max(last, edge + 1);
      } else if (edge >= at) {
        break;
      }
    }
    // The ends of the path rest and are never slowed. So the loop ends before the first edge does.
    std::size_t first = at;
    for (std::size_t edge = last;; --edge) {
      if (slow_begin(edge)) {
        first = std::min(first, edge);
      } else if (edge < at) {
        break;
      }
    }
    Change change{first, {}, 0.0};
    for (std::size_t edge = first - 1; edge <= last; ++edge) {
      change.gain += edge_seconds_[edge] - seconds_of(edge);
    }
    for (std::size_t k = first; k <= last; ++k) {
      change.blends.push_back(std::exchange(trial_[k], plan_[k]));
    }
    return change;
  }

  void take(const Change& change) {
    if (change.blends.empty()) {
      return;
    }
    for (std::size_t k = 0; k < change.blends.size(); ++k) {
      trial_[change.first + k] = plan_[change.first + k] = change.blends[k];
    }
    for (std::size_t edge = change.first - 1; edge < change.first + change.blends.size(); ++edge) {
      edge_seconds_[edge] = seconds_of(edge);
    }
    total_ -= change.gain;
  }

  [[nodiscard]] double way(std::size_t edge, std::size_t joint) const {
    return path_.waypoints[edge + 1][joint] - path_.waypoints[edge][joint];
  }

  /// [rad or m]  Half of T (w - u) of a joint, without its sign.
  [[nodiscard]] double half_turn(std::size_t at, double before, double after,
                                 std::size_t joint) const {
    return std::abs(after * way(at, joint) - before * way(at - 1, joint));
  }

  /// [-]  Factor of the lengths of a blend so that it stays near the path.
  [[nodiscard]] double nearness(std::size_t at, double before, double after) const {
    double factor = 1.0;
    for (std::size_t joint = 0; joint < limits_.size(); ++joint) {
      const double off = kDeviationByTurn * half_turn(at, before, after, joint);
      factor = off > deviation_ ? std::min(factor, deviation_ / off) : factor;
    }
    return factor;
  }

  /// The fastest blend of given lengths, or shorter ones where it would leave the path too far.
  [[nodiscard]] BlendPlan shortest_blend(std::size_t at, double before, double after) const {
    const double factor = nearness(at, before, after);
    before *= factor;
    after *= factor;
    if (!(before > 0.0 && after > 0.0)) {
      return {};
    }
    // A shorter phase would be made longer, and its rates lower than its neighbours count on.
    constexpr double kShortest = static_cast<double>(detail::kShortestPhase) * 1e-9;  // [s]
    double seconds =
        std::max({kShortest, 2.0 * before / lines_[at - 1].rate, 2.0 * after / lines_[at].rate});
    for (std::size_t joint = 0; joint < limits_.size(); ++joint) {
      const double turn = half_turn(at, before, after, joint);
      seconds = std::max(seconds, std::sqrt(3.0 * turn / (share_ * limits_[joint].acceleration)));
      if (limits_[joint].jerk) {
        seconds = std::max(seconds, std::cbrt(12.0 * turn / (share_ * *limits_[joint].jerk)));
      }
    }
    return {before, after, seconds};
  }

  /// Whether a way has room for a ramp between two rates.
  static bool has_room(double from, double to, double way, const LineLimits& line) {
    return detail::ramp_way(from, to, line) + 0.5 * (from + to) * detail::kRampRoom <= way;
  }

  /// The highest rate at the other end of a way that begins with `rate`.
  static double reachable(double rate, double wanted, double way, const LineLimits& line) {
    double low = rate;
    double high = wanted;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (has_room(rate, middle, way, line) ? low : high) = middle;
    }
    return low;
  }

  /// [-]  Length of an edge between its blends.
  [[nodiscard]] double straight_way(std::size_t edge) const {
    return 1.0 - trial_[edge].after - trial_[edge + 1].before;
  }

  /// Slows the blend at the end of an edge to the rate that is reachable from its begin.
  bool slow_end(std::size_t edge) {
    BlendPlan& next = trial_[edge + 1];
    const double from = trial_[edge].rate_after();
    const double wanted = next.rate_before();
    const double way = straight_way(edge);
    if (!(wanted > from) || has_room(from, wanted, way, lines_[edge])) {
      return false;
    }
    next.seconds = 2.0 * next.before / reachable(from, wanted, way, lines_[edge]);
    return true;
  }

  /// Slows the blend at the begin of an edge to a rate from which its end can be reached.
  bool slow_begin(std::size_t edge) {
    BlendPlan& last = trial_[edge];
    const double to = trial_[edge + 1].rate_before();
    const double wanted = last.rate_after();
    const double way = straight_way(edge);
    if (!(wanted > to) || has_room(to, wanted, way, lines_[edge])) {
      return false;
    }
    last.seconds = 2.0 * last.after / reachable(to, wanted, way, lines_[edge]);
    return true;
  }

  /// [s]  Time of an edge and the blend behind it; infinite where the rates of its blends cannot be
  /// reached.
  [[nodiscard]] double seconds_of(std::size_t edge) const {
    const double from = trial_[edge].rate_after();
    const double to = trial_[edge + 1].rate_before();
    const double way = straight_way(edge);
    if (!std::isfinite(trial_[edge + 1].seconds) || !has_room(from, to, way, lines_[edge])) {
      return kNever;
    }
    return detail::line_seconds(way, from, to, lines_[edge]) + trial_[edge + 1].seconds;
  }

  const WaypointPath& path_;
  const std::vector<RateLimits>& limits_;
  const std::vector<double>& longest_;
  double share_;
  double deviation_;  // [rad or m]
  std::vector<LineLimits> lines_;
  std::vector<BlendPlan> plan_;
  std::vector<BlendPlan> trial_;      // As plan_, except for the blends on trial.
  std::vector<double> edge_seconds_;  // [s]  As seconds_of().
  double total_ = 0.0;                // [s]
};

std::int64_t whole_blend(double seconds) {
  return std::max(detail::kShortestPhase, detail::whole_nanoseconds_up(seconds));
}

}  // namespace

BlendedMotion blend_motion(const WaypointPath& path, const std::vector<RateLimits>& limits,
                           const std::vector<double>& longest, double share, double deviation) {
  require_path(path);
  require_limits(path.joint_names, limits);
  if (longest.size() + 2 != path.waypoints.size()) {
    throw std::invalid_argument("expected a longest blend for each waypoint between the ends");
  }
  const FloatEnvironmentGuard guard;
  BlendPlanner planner(path, limits, longest, share, deviation);
  std::vector<BlendPlan> plan = planner.run();
  detail::MotionWriter writer(path, true);
  BlendedMotion result;
  for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
    BlendPlan& next = plan[edge + 1];
    const std::int64_t time = next.seconds > 0.0 ? whole_blend(next.seconds) : 0;
    next.seconds = static_cast<double>(time) / 1e9;
    const double from = plan[edge].after;
    const double to = 1.0 - next.before;
    writer.follow(edge, from, to,
                  detail::line_profile(to - from, plan[edge].rate_after(), next.rate_before(),
                                       planner.line(edge)));
    const std::int64_t begin = writer.now();
    if (time > 0) {
      writer.add(time, writer.on_edge(edge + 1, {next.after, next.rate_after(), 0.0}));
    }
    if (edge + 2 < path.waypoints.size()) {
      result.blends.push_back({next.before, next.after, begin, begin + time});
    }
  }
  result.motion = writer.take();
  return result;
}

}  // namespace firstcontact
