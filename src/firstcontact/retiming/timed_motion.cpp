#include <firstcontact/retiming/timed_motion.h>

#include <cmath>
#include <stdexcept>

#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

std::int64_t whole_nanoseconds(double seconds) {
  const double product = seconds * kNanosecondsPerSecond;
  const double rounded = std::round(product);
  // The nearest double of a whole nanosecond is within half a unit; the product adds another half.
  const double slack = 0x1p-51 * product;
  if (!(product >= 0.0 && product <= kLatestTime && std::abs(product - rounded) <= slack)) {
    throw std::invalid_argument("expected a time in whole nanoseconds, got " +
                                detail::write_json(seconds) + " s");
  }
  return static_cast<std::int64_t>(rounded);
}

void require_rate(const std::string& joint, const char* what, double value) {
  if (!(value > 0.0 && std::isfinite(value))) {
    throw std::invalid_argument("joint " + detail::in_quotes(joint) + ": expected a limit of the " +
                                what + " that is finite and > 0, got " +
                                (std::isfinite(value) ? detail::write_json(value)
                                 : std::isnan(value)  ? std::string("NaN")
                                                      : std::string("infinity")));
  }
}

}  // namespace

Trajectory trajectory_of(const TimedMotion& motion) {
  Trajectory trajectory;
  trajectory.joint_names = motion.joint_names;
  trajectory.points.reserve(motion.points.size());
  for (const TimedPoint& point : motion.points) {
    trajectory.points.push_back({.time = static_cast<double>(point.time) / kNanosecondsPerSecond,
                                 .positions = point.positions,
                                 .velocities = point.velocities,
                                 .accelerations = point.accelerations});
  }
  return trajectory;
}

TimedMotion timed_motion_of(const Trajectory& trajectory) {
  TimedMotion motion;
  motion.joint_names = trajectory.joint_names;
  motion.points.reserve(trajectory.points.size());
  for (const TrajectoryPoint& point : trajectory.points) {
    const std::int64_t time = whole_nanoseconds(point.time);
    if (!motion.points.empty() && time <= motion.points.back().time) {
      throw std::invalid_argument("expected times that increase by a nanosecond or more, got " +
                                  detail::write_json(point.time) + " s twice");
    }
    motion.points.push_back({.time = time,
                             .positions = point.positions,
                             .velocities = point.velocities,
                             .accelerations = point.accelerations});
  }
  return motion;
}

void require_limits(const std::vector<std::string>& joint_names,
                    const std::vector<RateLimits>& limits) {
  if (limits.size() != joint_names.size()) {
    throw std::invalid_argument("expected limits for each of the " +
                                std::to_string(joint_names.size()) + " joints, got " +
                                std::to_string(limits.size()));
  }
  for (std::size_t k = 0; k < limits.size(); ++k) {
    require_rate(joint_names[k], "velocity", limits[k].velocity);
    require_rate(joint_names[k], "acceleration", limits[k].acceleration);
    if (limits[k].jerk) {
      require_rate(joint_names[k], "jerk", *limits[k].jerk);
    }
  }
}

}  // namespace firstcontact
