#include <firstcontact/retiming/detail/line_profile.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact::detail {
namespace {

constexpr double kNano = 1e9;

[[noreturn]] void refuse_slowness() {
  throw std::invalid_argument(
      "expected limits with which the motion ends within 13 days; they are too small for its way");
}

/// A change of rate: jerk for `bend`, constant acceleration for `straight`, jerk back for `bend`.
struct Ramp {
  double bend = 0.0;      // [s]
  double straight = 0.0;  // [s]

  [[nodiscard]] double seconds() const { return 2.0 * bend + straight; }
};

Ramp fastest_ramp(double change, const LineLimits& limits) {
  const double size = std::abs(change);
  if (!limits.has_jerk()) {
    return {0.0, size / limits.acceleration};
  }
  const double full_bend = limits.acceleration / limits.jerk;
  if (size >= limits.acceleration * full_bend) {
    return {full_bend, size / limits.acceleration - full_bend};
  }
  return {std::sqrt(size / limits.jerk), 0.0};
}

/// The highest rate between two ramps that fit into the way, at least that of both ends.
double rate_between(double way, double from, double to, const LineLimits& limits) {
  const auto fits = [&](double rate) {
    return ramp_way(from, rate, limits) + ramp_way(rate, to, limits) <= way;
  };
  if (fits(limits.rate)) {
    return limits.rate;
  }
  double low = std::max(from, to);
  double high = limits.rate;
  for (int k = 0; k < 100 && low < high; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) {
      break;
    }
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

/// [s]  Time between the ramps; none where the rate is below its limit.
double cruise_seconds(double way, double from, double to, double rate, const LineLimits& limits) {
  if (rate < limits.rate && rate > std::max(from, to)) {
    return 0.0;
  }
  const double left = way - ramp_way(from, rate, limits) - ramp_way(rate, to, limits);
  return rate > 0.0 ? std::max(0.0, left / rate) : 0.0;
}

/// [ns]  The time of a phase, rounded up; none is between 0 and the shortest one.
std::int64_t phase(double seconds) {
  return seconds > 0.0 ? std::max(kShortestPhase, whole_nanoseconds_up(seconds)) : 0;
}

struct WholeRamp {
  std::int64_t bend = 0;      // [ns]
  std::int64_t straight = 0;  // [ns]

  [[nodiscard]] double seconds() const { return static_cast<double>(2 * bend + straight) / kNano; }
};

WholeRamp whole(const Ramp& ramp) {
  if (ramp.bend == 0.0) {
    return {0, phase(ramp.straight)};
  }
  const double shortest = static_cast<double>(kShortestPhase) / kNano;
  // A short phase between the bends is added to both: that gives few nodes and lower rates.
  return ramp.straight < shortest ? WholeRamp{phase(ramp.bend + ramp.straight), 0}
                                  : WholeRamp{phase(ramp.bend), phase(ramp.straight)};
}

/// Appends the nodes of one phase after another.
class LineWriter {
 public:
  explicit LineWriter(double rate) { state_.rate = rate; }

  void ramp(const WholeRamp& ramp, double to) {
    const double change = to - state_.rate;
    const double bend = static_cast<double>(ramp.bend) / kNano;
    const double straight = static_cast<double>(ramp.straight) / kNano;
    if (ramp.bend == 0) {
      if (ramp.straight > 0) {
        state_.acceleration = change / straight;
        add(ramp.straight, 0.0);
      }
    } else {
      const double jerk = change / (bend * (bend + straight));
      add(ramp.bend, jerk);
      if (ramp.straight > 0) {
        add(ramp.straight, 0.0);
      }
      add(ramp.bend, -jerk);
    }
    end(to);
  }

  void cruise(std::int64_t time) {
    if (time > 0) {
      add(time, 0.0);
    }
  }

  [[nodiscard]] std::vector<LineNode> take(double way, double rate) {
    nodes_.back().state = {way, rate, 0.0};
    return std::move(nodes_);
  }

 private:
  void add(std::int64_t time, double jerk) {
    const double t = static_cast<double>(time) / kNano;
    state_.x += t * (state_.rate + t * (0.5 * state_.acceleration + t * jerk / 6.0));
    state_.rate += t * (state_.acceleration + 0.5 * t * jerk);
    state_.acceleration += t * jerk;
    nodes_.push_back({time, state_});
  }

  /// Ends the profile at a rate, without the remains of rounding.
  void end(double rate) {
    state_.rate = rate;
    state_.acceleration = 0.0;
    if (!nodes_.empty()) {
      nodes_.back().state = state_;
    }
  }

  LineState state_;
  std::vector<LineNode> nodes_;
};

}  // namespace

std::int64_t whole_nanoseconds_up(double seconds) {
  const double time = std::ceil(seconds * kNano);
  if (!(time <= kLatestTime)) {
    refuse_slowness();
  }
  return static_cast<std::int64_t>(time);
}

double ramp_seconds(double change, const LineLimits& limits) {
  return fastest_ramp(change, limits).seconds();
}

double ramp_way(double from, double to, const LineLimits& limits) {
  return 0.5 * (from + to) * ramp_seconds(to - from, limits);
}

double line_seconds(double way, double from, double to, const LineLimits& limits) {
  const double rate = rate_between(way, from, to, limits);
  return ramp_seconds(rate - from, limits) + cruise_seconds(way, from, to, rate, limits) +
         ramp_seconds(to - rate, limits);
}

std::vector<LineNode> line_profile(double way, double from, double to, const LineLimits& limits) {
  const double rate = rate_between(way, from, to, limits);
  WholeRamp up = whole(fastest_ramp(rate - from, limits));
  WholeRamp down = whole(fastest_ramp(rate - to, limits));
  std::int64_t cruise = phase(cruise_seconds(way, from, to, rate, limits));
  const auto between = [&] {
    const double mean_time =
        0.5 * up.seconds() + static_cast<double>(cruise) / kNano + 0.5 * down.seconds();
    if (!(mean_time > 0.0)) {
      refuse_slowness();  // The rates are below those that doubles of this size distinguish from 0.
    }
    return (way - 0.5 * (from * up.seconds() + to * down.seconds())) / mean_time;
  };
  double middle = between();
  const double highest = std::max(from, to);
  if (!(middle >= highest)) {
    // The longer phases leave no room for a ramp up, so the rate of the higher end is kept for a
    // while.
    const WholeRamp ramp = whole(fastest_ramp(std::abs(to - from), limits));
    up = from < to ? ramp : WholeRamp{};
    down = from < to ? WholeRamp{} : ramp;
    const double left = way - 0.5 * (from + to) * ramp.seconds();
    cruise = std::max<std::int64_t>(0, std::llround(left / highest * kNano));
    middle = between();
  }
  LineWriter writer(from);
  writer.ramp(up, middle);
  writer.cruise(cruise);
  writer.ramp(down, to);
  return writer.take(way, to);
}

}  // namespace firstcontact::detail
