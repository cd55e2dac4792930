#include <firstcontact/retiming/rate_report.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/bezier.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::Bezier;
using detail::Peak;
using detail::SegmentRates;

const Bezier& of_rate(const SegmentRates& rates, JointRate what) {
  switch (what) {
    case JointRate::velocity:
      return rates.velocity;
    case JointRate::acceleration:
      return rates.acceleration;
    case JointRate::jerk:
      break;
  }
  return rates.jerk;
}

/// One coordinate of a motion, segment by segment.
class CoordinateRates {
 public:
  CoordinateRates(const TimedMotion& motion, std::size_t joint) : motion_(motion), joint_(joint) {
    for (std::size_t k = 0; k + 1 < motion.points.size(); ++k) {
      segments_.push_back(detail::segment_rates(motion.points[k], motion.points[k + 1], joint));
    }
  }

  [[nodiscard]] RateUse use(JointRate what, double limit) const {
    RateUse use{.joint = joint_, .what = what, .limit = limit};
    for (std::size_t k = 0; k < segments_.size(); ++k) {
      const Peak found = detail::peak(of_rate(segments_[k], what), use.bound);
      use.bound = std::max(use.bound, found.bound);
      if (found.attained > use.attained) {
        use.attained = found.attained;
        use.time = time_in(k, found.where);
      }
    }
    if (what == JointRate::acceleration) {
      add_jumps(JointRate::velocity, motion_.has_velocities(), use);
    } else if (what == JointRate::jerk) {
      add_jumps(JointRate::velocity, motion_.has_velocities(), use);
      add_jumps(JointRate::acceleration, motion_.has_accelerations(), use);
    }
    return use;
  }

 private:
  /// [s]  A time within a segment, rounded.
  [[nodiscard]] double time_in(std::size_t segment, double where) const {
    const auto from = static_cast<double>(motion_.points[segment].time);
    const auto to = static_cast<double>(motion_.points[segment + 1].time);
    return (from + where * (to - from)) / 1e9;
  }

  /// Makes the limited rate infinite where the rate below it jumps.
  ///
  /// @param is_given  whether the points have the number: it is then the same on both sides of an
  ///                  inner point
  void add_jumps(JointRate below, bool is_given, RateUse& use) const {
    const Interval rest(0.0);
    for (std::size_t k = 0; k < motion_.points.size(); ++k) {
      const bool is_end = k == 0 || k + 1 == motion_.points.size();
      if (is_given && !is_end) {
        continue;
      }
      const Interval before = k == 0 ? rest : of_rate(segments_[k - 1], below).last();
      const Interval after = k == segments_.size() ? rest : of_rate(segments_[k], below).first();
      if (given_is_zero(k, below, is_given) ||
          (before == after && before.lower() == before.upper())) {
        continue;
      }
      constexpr double kInfinite = std::numeric_limits<double>::infinity();
      use.bound = kInfinite;
      if (disjoint(before, after) && use.attained < kInfinite) {
        use.attained = kInfinite;
        use.time = static_cast<double>(motion_.points[k].time) / 1e9;
      }
    }
  }

  /// Whether the given number of a point is 0, as at rest, where enclosures of an end may be wide.
  [[nodiscard]] bool given_is_zero(std::size_t point, JointRate below, bool is_given) const {
    const TimedPoint& at = motion_.points[point];
    return is_given &&
           (below == JointRate::velocity ? at.velocities : at.accelerations)[joint_] == 0.0;
  }

  const TimedMotion& motion_;
  std::size_t joint_;
  std::vector<SegmentRates> segments_;
};

}  // namespace

std::vector<RateUse> rate_report(const TimedMotion& motion, const std::vector<RateLimits>& limits) {
  require_limits(motion.joint_names, limits);
  const FloatEnvironmentGuard guard;
  std::vector<RateUse> report;
  for (std::size_t joint = 0; joint < limits.size(); ++joint) {
    const CoordinateRates rates(motion, joint);
    report.push_back(rates.use(JointRate::velocity, limits[joint].velocity));
    report.push_back(rates.use(JointRate::acceleration, limits[joint].acceleration));
    if (limits[joint].jerk) {
      report.push_back(rates.use(JointRate::jerk, *limits[joint].jerk));
    }
  }
  return report;
}

std::optional<RateUse> rate_beyond_limit(const std::vector<RateUse>& report) {
  const auto share = [](const RateUse& use) {
    return use.is_beyond() ? use.attained / use.limit : 1.0;
  };
  std::optional<RateUse> worst;
  for (const RateUse& use : report) {
    if (!use.is_within() && (!worst || share(use) > share(*worst))) {
      worst = use;
    }
  }
  return worst;
}

std::string describe(const RateUse& use, const std::string& joint, bool is_prismatic) {
  const std::string rate = kJointRateWords.at(static_cast<std::size_t>(use.what));
  const std::string unit =
      std::string(is_prismatic ? "m" : "rad") + (use.what == JointRate::velocity       ? "/s"
                                                 : use.what == JointRate::acceleration ? "/s^2"
                                                                                       : "/s^3");
  const std::string at = " at " + detail::quantity(use.time, "s");
  const std::string limit = " its limit of " + detail::quantity(use.limit, unit.c_str());
  const std::string subject = "joint " + detail::in_quotes(joint);
  if (std::isinf(use.attained)) {
    return subject + " jumps" + at + ": its " + rate + " is infinite, beyond" + limit;
  }
  if (use.is_beyond()) {
    return subject + " reaches a " + rate + " of " + detail::quantity(use.attained, unit.c_str()) +
           at + ", beyond" + limit;
  }
  return subject + ": its " + rate + " is not proven to stay within" + limit;
}

}  // namespace firstcontact
