#include <firstcontact/retiming/detail/limit_breaks.h>

#include <cstddef>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/bezier.h>

namespace firstcontact::detail {
namespace {

bool keeps(const Bezier& rate, double limit) { return peak(rate).bound <= limit; }

bool keeps_limits(const TimedPoint& from, const TimedPoint& to,
                  const std::vector<RateLimits>& limits) {
  for (std::size_t joint = 0; joint < limits.size(); ++joint) {
    const SegmentRates rates = segment_rates(from, to, joint);
    const RateLimits& limit = limits[joint];
    if (!keeps(rates.velocity, limit.velocity) || !keeps(rates.acceleration, limit.acceleration) ||
        (limit.jerk && !keeps(rates.jerk, *limit.jerk))) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<LimitBreak> limit_breaks(const TimedMotion& motion,
                                     const std::vector<RateLimits>& limits) {
  const FloatEnvironmentGuard guard;
  std::vector<LimitBreak> breaks;
  for (std::size_t k = 0; k + 1 < motion.points.size(); ++k) {
    if (!keeps_limits(motion.points[k], motion.points[k + 1], limits)) {
      breaks.push_back({motion.points[k].time, motion.points[k + 1].time});
    }
  }
  return breaks;
}

}  // namespace firstcontact::detail
