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

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The blend at one waypoint, in the units of the edges.
struct BlendPlan {
  double before = 0.0;   // [-]
  double after = 0.0;    // [-]
  double seconds = 0.0;  // [s]  0: rest.

  [[nodiscard]] double rate_before() const { return seconds > 0.0 ? 2.0 * before / seconds : 0.0; }
  [[nodiscard]] double rate_after() const { return seconds > 0.0 ? 2.0 * after / seconds : 0.0; }
};

/// Chooses the lengths and the times of all blends.
class BlendPlanner {
 public:
  BlendPlanner(const WaypointPath& path, const std::vector<RateLimits>& limits,
               const std::vector<double>& longest, double share)
      : path_(path), limits_(limits), longest_(longest), share_(share) {
    for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
      lines_.push_back(detail::line_limits(path, edge, limits, share, true));
    }
    plan_.resize(path.waypoints.size());
  }

  /// One blend for each waypoint; those of the ends are none.
  std::vector<BlendPlan> run() {
    double best = seconds_of(plan_);
    constexpr int kSweeps = 4;
    bool has_changed = true;
    for (int sweep = 0; sweep < kSweeps && has_changed; ++sweep) {
      has_changed = false;
      for (std::size_t at = 1; at + 1 < plan_.size(); ++at) {
        has_changed = improve(at, best) || has_changed;
      }
    }
    (void)seconds_of(plan_);  // Leaves the times in it.
    return std::move(plan_);
  }

  [[nodiscard]] const LineLimits& line(std::size_t edge) const { return lines_[edge]; }

 private:
  /// The best length of one blend while the others keep theirs.
  bool improve(std::size_t at, double& best) {
    constexpr std::array<double, 11> kShares{1.0,  0.75, 0.55, 0.4,  0.3, 0.22,
                                             0.16, 0.11, 0.07, 0.04, 0.0};
    const double longest = longest_[at - 1];
    const double in = lines_[at - 1].rate;
    const double out = lines_[at].rate;
    // Either as long in time at the highest rates, or the same share of both edges.
    const std::array<std::array<double, 2>, 2> kinds{
        {{in / std::max(in, out), out / std::max(in, out)}, {1.0, 1.0}}};
    std::vector<BlendPlan> chosen;
    const double before = best;
    for (const auto& kind : kinds) {
      for (const double part : kShares) {
        std::vector<BlendPlan> trial = plan_;
        trial[at] = shortest_blend(at, longest * part * kind[0], longest * part * kind[1]);
        const double seconds = seconds_of(trial);
        if (seconds < best) {
          best = seconds;
          chosen = std::move(trial);
        }
      }
    }
    if (!chosen.empty()) {
      plan_ = std::move(chosen);
    }
    constexpr double kWorthwhile = 1e-4;  // Relative.
    return best < before * (1.0 - kWorthwhile);
  }

  [[nodiscard]] double way(std::size_t edge, std::size_t joint) const {
    return path_.waypoints[edge + 1][joint] - path_.waypoints[edge][joint];
  }

  /// The fastest blend of given lengths.
  [[nodiscard]] BlendPlan shortest_blend(std::size_t at, double before, double after) const {
    if (!(before > 0.0 && after > 0.0)) {
      return {};
    }
    double seconds = std::max(2.0 * before / lines_[at - 1].rate, 2.0 * after / lines_[at].rate);
    for (std::size_t joint = 0; joint < limits_.size(); ++joint) {
      // Half of T (w - u).
      const double turn = std::abs(after * way(at, joint) - before * way(at - 1, joint));
      seconds = std::max(seconds, std::sqrt(3.0 * turn / (share_ * limits_[joint].acceleration)));
      if (limits_[joint].jerk) {
        seconds = std::max(seconds, std::cbrt(12.0 * turn / (share_ * *limits_[joint].jerk)));
      }
    }
    return {before, after, seconds};
  }

  /// Whether a way has the room for a ramp between two rates.
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

  /// [-]  Of an edge between its blends.
  static double straight_way(const std::vector<BlendPlan>& plan, std::size_t edge) {
    return 1.0 - plan[edge].after - plan[edge + 1].before;
  }

  /// Slows blends down until each edge can change from the rate of one to that of the next.
  void make_reachable(std::vector<BlendPlan>& plan) const {
    for (std::size_t edge = 0; edge + 1 < plan.size(); ++edge) {
      const double from = plan[edge].rate_after();
      BlendPlan& next = plan[edge + 1];
      const double way = straight_way(plan, edge);
      const double wanted = next.rate_before();
      if (wanted > from && !has_room(from, wanted, way, lines_[edge])) {
        next.seconds = 2.0 * next.before / reachable(from, wanted, way, lines_[edge]);
      }
    }
    for (std::size_t edge = plan.size() - 1; edge-- > 0;) {
      const double to = plan[edge + 1].rate_before();
      BlendPlan& last = plan[edge];
      const double way = straight_way(plan, edge);
      const double wanted = last.rate_after();
      if (wanted > to && !has_room(to, wanted, way, lines_[edge])) {
        last.seconds = 2.0 * last.after / reachable(to, wanted, way, lines_[edge]);
      }
    }
  }

  /// [s]  Of the whole motion; its blends are made as fast as their neighbours let them.
  double seconds_of(std::vector<BlendPlan>& plan) const {
    make_reachable(plan);
    double sum = 0.0;
    for (std::size_t edge = 0; edge + 1 < plan.size(); ++edge) {
      const double from = plan[edge].rate_after();
      const double to = plan[edge + 1].rate_before();
      const double way = straight_way(plan, edge);
      if (!std::isfinite(plan[edge + 1].seconds) || !has_room(from, to, way, lines_[edge])) {
        return kNever;
      }
      sum += detail::line_seconds(way, from, to, lines_[edge]) + plan[edge + 1].seconds;
    }
    return sum;
  }

  const WaypointPath& path_;
  const std::vector<RateLimits>& limits_;
  const std::vector<double>& longest_;
  double share_;
  std::vector<LineLimits> lines_;
  std::vector<BlendPlan> plan_;
};

std::int64_t whole_blend(double seconds) {
  return std::max(detail::kShortestPhase, static_cast<std::int64_t>(std::ceil(seconds * 1e9)));
}

}  // namespace

BlendedMotion blend_motion(const WaypointPath& path, const std::vector<RateLimits>& limits,
                           const std::vector<double>& longest, double share) {
  require_path(path);
  require_limits(path.joint_names, limits);
  if (longest.size() + 2 != path.waypoints.size()) {
    throw std::invalid_argument("expected a longest blend for each waypoint between the ends");
  }
  const FloatEnvironmentGuard guard;
  BlendPlanner planner(path, limits, longest, share);
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
