/// @file
/// Motion along a straight line between two rates: ramp, cruise, ramp, in whole nanoseconds.

#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace firstcontact::detail {

/// The limits of a motion x(t) along a line.
struct LineLimits {
  double rate = 0.0;                                      ///< [1/s]
  double acceleration = 0.0;                              ///< [1/s^2]
  double jerk = std::numeric_limits<double>::infinity();  ///< [1/s^3]

  [[nodiscard]] bool has_jerk() const { return jerk < std::numeric_limits<double>::infinity(); }
};

/// x and its derivatives at one time.
struct LineState {
  double x = 0.0;
  double rate = 0.0;          ///< [1/s]
  double acceleration = 0.0;  ///< [1/s^2]
};

/// The end of a phase of constant jerk (of constant acceleration, where jerk is not limited).
struct LineNode {
  std::int64_t after = 0;  ///< [ns]  Since the node before; > 0.
  LineState state;
};

/// No phase is shorter: the numbers of the points are doubles, whose rounding of 1e-16 is a jerk of
/// 1e-16 / T^3 on a segment of length T.
inline constexpr std::int64_t kShortestPhase = 1'000'000;  // [ns]

/// A time in whole nanoseconds, rounded up [ns].
///
/// @throws std::invalid_argument beyond 13 days, as doubles of seconds do not distinguish
///         nanoseconds there
[[nodiscard]] std::int64_t whole_nanoseconds_up(double seconds);

/// [s]  The time of the fastest ramp that changes the rate by `change`.
[[nodiscard]] double ramp_seconds(double change, const LineLimits& limits);

/// The length of the fastest ramp from one rate to another: its mean rate times its time.
[[nodiscard]] double ramp_way(double from, double to, const LineLimits& limits);

/// [s]  The time that whole nanoseconds and the shortest phases need in addition to the fastest
/// ramp.
inline constexpr double kRampRoom = 4e-3;

/// Runs from x = 0 to x = `way`, from one rate to another, as fast as the limits allow.
///
/// Accelerations are 0 at both ends. Times are rounded up to nanoseconds. The rate between the
/// ramps is computed anew, so that the length stays.
///
/// From rest to rest that is the time-optimal motion, except for phases below kShortestPhase and
/// the rounding. No limit is exceeded: longer phases lower the rate, the accelerations and the
/// jerks. From other rates a limit may be exceeded by a relative 1e-6; the caller proves the
/// result.
///
/// Derivation: both ramps have a mean rate that is the mean of their ends. So the rate p in between
/// follows from  p (T1 / 2 + Tc + T2 / 2) = way - (from T1 + to T2) / 2.
///
/// @param way       > 0, at least ramp_way(from, to) with kRampRoom added to the ramp's time
/// @param from, to  [1/s]  >= 0, at most the limit of the rate
/// @throws std::invalid_argument as whole_nanoseconds_up()
[[nodiscard]] std::vector<LineNode> line_profile(double way, double from, double to,
                                                 const LineLimits& limits);

/// [s]  The time of line_profile(), before rounding.
[[nodiscard]] double line_seconds(double way, double from, double to, const LineLimits& limits);

}  // namespace firstcontact::detail
