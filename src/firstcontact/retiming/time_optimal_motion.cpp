#include <firstcontact/retiming/time_optimal_motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/blended_path.h>
#include <firstcontact/retiming/detail/line_profile.h>
#include <firstcontact/retiming/detail/phase_plane.h>
#include <firstcontact/retiming/rate_report.h>

namespace firstcontact {
namespace {

using detail::BlendedPath;
using detail::PathTiming;

/// The points between two rests; times from 0 on.
struct Stretch {
  std::vector<TimedPoint> points;
  std::vector<Blend> blends;  // Blends with times of the stretch.
};

/// The factor for all times so that all limits hold.
double needed_slowness(const std::vector<RateUse>& report) {
  double slowness = 0.0;
  for (const RateUse& use : report) {
    const double share = use.bound / use.limit;
    slowness = std::max(slowness, use.what == JointRate::velocity       ? share
                                  : use.what == JointRate::acceleration ? std::sqrt(share)
                                                                        : std::cbrt(share));
  }
  return slowness;
}

/// Moves along one stretch of the path, averaged over a window.
class StretchTimer {
 public:
  StretchTimer(const WaypointPath& path, const std::vector<Blend>& blends, std::size_t first,
               std::size_t last, const std::vector<RateLimits>& limits, double share)
      : path_(path),
        first_(first),
        last_(last),
        limits_(limits),
        share_(share),
        geometry_(path, blends, first, last),
        timing_(detail::phase_plane(geometry_, limits, share)) {}

  /// Times the stretch; none where the grid found no motion faster than a given one.
  [[nodiscard]] std::optional<Stretch> run(double seconds) const {
    if (!(timing_.duration() < seconds)) {
      return std::nullopt;
    }
    constexpr std::array<double, 5> kWindows{0.008, 0.016, 0.032, 0.064, 0.128};  // [s]
    std::optional<Stretch> best;
    for (const double window : kWindows) {
      Stretch stretch = averaged(window_scale(kWindows.front()) * window);
      if (!best || stretch.points.back().time < best->points.back().time) {
        best = std::move(stretch);
      }
    }
    return best;
  }

 private:
  /// [-]  Factor of the windows. Low limits slow a motion down, and its windows with it.
  ///
  /// Otherwise the number of points, and the work, would grow with the duration.
  [[nodiscard]] double window_scale(double shortest) const {
    constexpr double kWindowsPerEdge = 500.0;
    const auto edges = static_cast<double>(last_ - first_);
    return std::max(1.0, timing_.duration() / (kWindowsPerEdge * edges * shortest));
  }

  [[nodiscard]] TimedPoint point_at(double t, double window) const {
    const PathTiming::State state = timing_.averaged(t, window);
    const detail::PathPlace place = geometry_.place(state.S);
    TimedPoint point;
    for (std::size_t j = 0; j < place.p.size(); ++j) {
      point.positions.push_back(place.p[j]);
      point.velocities.push_back(place.dp[j] * state.rate);
      point.accelerations.push_back(place.dp[j] * state.acceleration +
                                    place.ddp[j] * state.rate * state.rate);
    }
    return point;
  }

  [[nodiscard]] TimedPoint at_rest(std::size_t waypoint) const {
    const std::vector<double> zeros(path_.waypoints[waypoint].size(), 0.0);
    return {0, path_.waypoints[waypoint], zeros, zeros};
  }

  /// The time at which the averaged motion passes a place; it never goes back.
  [[nodiscard]] double time_at(double S, double window) const {
    double low = 0.0;
    double high = timing_.duration() + window;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (timing_.averaged(middle, window).S < S ? low : high) = middle;
    }
    return low;
  }

  /// The averaged motion, stretched until the limits hold.
  [[nodiscard]] Stretch averaged(double window) const {
    const Stretch stretch = averaged(window, 1.0);
    const auto report = rate_report({path_.joint_names, stretch.points}, limits_);
    return averaged(window, needed_slowness(report) / share_);
  }

  /// The averaged motion at whole nanoseconds, so that no number is off by the rounding of times.
  [[nodiscard]] Stretch averaged(double window, double slowness) const {
    const double duration = (timing_.duration() + window) * slowness;
    const double cells = std::ceil(duration / (0.5 * window * slowness));
    Stretch stretch{{at_rest(first_)}, {}};
    for (double k = 1.0; k < cells; k += 1.0) {
      const std::int64_t time = std::llround(k / cells * duration * 1e9);
      TimedPoint point = point_at(static_cast<double>(time) * 1e-9 / slowness, window);
      point.time = time;
      for (std::size_t j = 0; j < point.velocities.size(); ++j) {
        point.velocities[j] /= slowness;
        point.accelerations[j] /= slowness * slowness;
      }
      stretch.points.push_back(std::move(point));
    }
    stretch.points.push_back(at_rest(last_));
    stretch.points.back().time = detail::whole_nanoseconds_up(duration);
    for (const BlendedPath::Piece& piece : geometry_.pieces()) {
      if (piece.is_blend) {
        const auto time = [&](double S) {
          return std::llround(time_at(S, window) * slowness * 1e9);
        };
        stretch.blends.push_back({piece.before, piece.after, time(piece.begin), time(piece.end)});
      }
    }
    return stretch;
  }

  const WaypointPath& path_;
  std::size_t first_;
  std::size_t last_;
  const std::vector<RateLimits>& limits_;
  double share_;
  BlendedPath geometry_;
  PathTiming timing_;
};

/// The points of a motion between two times, both ends included; times from 0 on.
Stretch stretch_of(const BlendedMotion& blended, std::int64_t begin, std::int64_t end,
                   std::size_t first, std::size_t last) {
  Stretch stretch;
  const std::vector<TimedPoint>& points = blended.motion.points;
  const auto is_before = [](const TimedPoint& point, std::int64_t time) {
    return point.time < time;
  };
  for (auto point = std::lower_bound(points.begin(), points.end(), begin, is_before);
       point != points.end() && point->time <= end; ++point) {
    stretch.points.push_back(*point);
    stretch.points.back().time -= begin;
  }
  for (std::size_t waypoint = first + 1; waypoint < last; ++waypoint) {
    Blend blend = blended.blends[waypoint - 1];
    blend.begin -= begin;
    blend.end -= begin;
    stretch.blends.push_back(blend);
  }
  return stretch;
}

}  // namespace

BlendedMotion time_optimal_motion(const BlendedMotion& blended, const WaypointPath& path,
                                  const std::vector<RateLimits>& limits, double share) {
  const FloatEnvironmentGuard guard;
  BlendedMotion result{{path.joint_names, {blended.motion.points.front()}}, {}};
  std::size_t first = 0;
  std::int64_t begin = 0;
  for (std::size_t last = 1; last < path.waypoints.size(); ++last) {
    const bool is_end = last + 1 == path.waypoints.size();
    const Blend rest =
        is_end ? Blend{.begin = blended.motion.points.back().time} : blended.blends[last - 1];
    if (!is_end && rest.end > rest.begin) {
      continue;
    }
    Stretch stretch = stretch_of(blended, begin, rest.begin, first, last);
    if (last - first > 1) {
      std::optional<Stretch> faster =
          StretchTimer(path, blended.blends, first, last, limits, share)
              .run(static_cast<double>(stretch.points.back().time) * 1e-9);
      if (faster && faster->points.back().time < stretch.points.back().time) {
        stretch = std::move(*faster);
      }
    }
    const std::int64_t now = result.motion.points.back().time;
    for (std::size_t k = 1; k < stretch.points.size(); ++k) {
      result.motion.points.push_back(std::move(stretch.points[k]));
      result.motion.points.back().time += now;
    }
    for (Blend blend : stretch.blends) {
      blend.begin += now;
      blend.end += now;
      result.blends.push_back(blend);
    }
    if (!is_end) {
      const std::int64_t at = result.motion.points.back().time;
      result.blends.push_back({.begin = at, .end = at});
    }
    first = last;
    begin = rest.begin;
  }
  return result;
}

}  // namespace firstcontact
