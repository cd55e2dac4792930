/// @file
/// Where a motion does not keep its limits.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact::detail {

/// A segment between two points on which a limit is not proven.
struct LimitBreak {
  std::int64_t begin = 0;  ///< [ns]
  std::int64_t end = 0;    ///< [ns]
};

/// The segments on which a limit is not proven, in order.
///
/// Jumps between segments are left out: motions with accelerations have none.
[[nodiscard]] std::vector<LimitBreak> limit_breaks(const TimedMotion& motion,
                                                   const std::vector<RateLimits>& limits);

}  // namespace firstcontact::detail
