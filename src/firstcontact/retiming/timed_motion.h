/// @file
/// The motion of joints as a trajectory controller executes it: points at whole nanoseconds.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact {

/// [ns]  The longest motion. Doubles of seconds distinguish nanoseconds up to here, 13 days.
inline constexpr double kLatestTime = 0x1p50;

/// The rates that a joint coordinate may have.
struct RateLimits {
  double velocity = 0.0;            ///< [rad/s or m/s]  > 0.
  double acceleration = 0.0;        ///< [rad/s^2 or m/s^2]  > 0.
  std::optional<double> jerk = {};  ///< [rad/s^3 or m/s^3]  > 0; without it jerk is not limited.
};

/// The state of all coordinates at one time, in the order of the motion's joint names.
struct TimedPoint {
  std::int64_t time = 0;                   ///< [ns]
  std::vector<double> positions = {};      ///< [rad or m]
  std::vector<double> velocities = {};     ///< [rad/s or m/s]  As many, or none.
  std::vector<double> accelerations = {};  ///< [rad/s^2 or m/s^2]  As many, or none; only with
                                           ///< velocities.

  friend bool operator==(const TimedPoint&, const TimedPoint&) = default;
};

/// The points between which a controller interpolates.
///
/// The interpolation is linear with positions alone, cubic with velocities, quintic with
/// accelerations too. The robot rests before the first point and after the last one.
struct TimedMotion {
  std::vector<std::string> joint_names = {};  ///< As trajectories name coordinates, each once.
  /// At least one. Times increase strictly; all points have the same kinds of numbers.
  std::vector<TimedPoint> points = {};

  [[nodiscard]] bool has_velocities() const {
    return !points.empty() && !points.front().velocities.empty();
  }
  [[nodiscard]] bool has_accelerations() const {
    return !points.empty() && !points.front().accelerations.empty();
  }
  /// [s]  Time from 0 to the last point, rounded.
  [[nodiscard]] double duration() const {
    return points.empty() ? 0.0 : static_cast<double>(points.back().time) / 1e9;
  }

  friend bool operator==(const TimedMotion&, const TimedMotion&) = default;
};

/// The motion as a trajectory: times are the doubles that are nearest to the nanoseconds.
[[nodiscard]] FIRSTCONTACT_API Trajectory trajectory_of(const TimedMotion& motion);

/// The motion of a trajectory whose times are whole nanoseconds.
///
/// @throws std::invalid_argument if a time is no whole nanosecond, to the rounding of a double, or
///         times do not increase strictly in nanoseconds
[[nodiscard]] FIRSTCONTACT_API TimedMotion timed_motion_of(const Trajectory& trajectory);

/// Refuses limits that are missing or make no sense.
///
/// @throws std::invalid_argument  names the joint
FIRSTCONTACT_API void require_limits(const std::vector<std::string>& joint_names,
                                     const std::vector<RateLimits>& limits);

}  // namespace firstcontact
