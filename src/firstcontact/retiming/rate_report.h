/// @file
/// The velocities, accelerations and jerks that a controller's interpolation reaches, proven.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact {

/// A rate of a joint coordinate.
enum class JointRate { velocity, acceleration, jerk };

/// The words of JointRate in messages and in files, in this order.
inline constexpr std::array<const char*, 3> kJointRateWords{"velocity", "acceleration", "jerk"};

/// The greatest size of one rate of one joint coordinate over a whole motion.
struct RateUse {
  std::size_t joint = 0;  ///< Index into the joint names of the motion.
  JointRate what = JointRate::velocity;
  double limit = 0.0;     ///< [rad or m; per s, s^2 or s^3]
  double attained = 0.0;  ///< The motion has this size, or more, at `time`.
  double bound = 0.0;     ///< Proven: the motion has no greater size. Infinite where it jumps.
  double time = 0.0;      ///< [s]  To the nanosecond.

  /// Whether it is proven that the limit holds everywhere.
  [[nodiscard]] bool is_within() const { return bound <= limit; }
  /// Whether it is proven that the limit does not hold at `time`.
  [[nodiscard]] bool is_beyond() const { return attained > limit; }
};

/// Finds the greatest rates of a motion, as its controller interpolates, for each limit.
///
/// The rates hold for the exact polynomials that the doubles of the points define, at all times
/// between them. Intervals enclose every operation. A jump of the velocity is an infinite
/// acceleration. A jump of the acceleration is an infinite jerk. The rest before the first point
/// and after the last counts.
///
/// @param limits  as require_limits() demands
/// @returns in the order of the joints, and of the rates that are limited
[[nodiscard]] FIRSTCONTACT_API std::vector<RateUse> rate_report(
    const TimedMotion& motion, const std::vector<RateLimits>& limits);

/// The use that is not proven to be within its limit, the one farthest beyond it; none if all are.
[[nodiscard]] FIRSTCONTACT_API std::optional<RateUse> rate_beyond_limit(
    const std::vector<RateUse>& report);

/// Describes a use: "joint "elbow" reaches a velocity of 2.1 rad/s at 0.52 s, beyond its limit of 2
/// rad/s".
///
/// @param is_prismatic  whether its unit is m in place of rad
[[nodiscard]] FIRSTCONTACT_API std::string describe(const RateUse& use, const std::string& joint,
                                                    bool is_prismatic);

}  // namespace firstcontact
