#include <firstcontact/retiming/stop_motion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/retiming/detail/bezier.h>
#include <firstcontact/retiming/detail/line_profile.h>
#include <firstcontact/retiming/detail/motion_writer.h>

namespace firstcontact {
namespace {

using detail::Bezier;

bool any_jerk_limit(const std::vector<RateLimits>& limits) {
  return std::any_of(limits.begin(), limits.end(),
                     [](const RateLimits& limit) { return limit.jerk.has_value(); });
}

/// The joint that goes farthest on an edge; the others follow it.
std::size_t leading_joint(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t leading = 0;
  for (std::size_t joint = 1; joint < a.size(); ++joint) {
    if (std::abs(b[joint] - a[joint]) > std::abs(b[leading] - a[leading])) {
      leading = joint;
    }
  }
  return leading;
}

bool rests_at(const TimedPoint& point, const std::vector<double>& waypoint) {
  const auto is_zero = [](double v) { return v == 0.0; };
  return point.positions == waypoint &&
         std::all_of(point.velocities.begin(), point.velocities.end(), is_zero);
}

/// A bound of the distance of all joints from the edge on one segment.
///
/// The leading joint's own motion defines x, so that it is on the edge for every x in [0, 1]. The
/// other joints are compared with it coefficient by coefficient. The difference of two polynomials
/// is no greater than that of their Bernstein coefficients.
double deviation_on(const TimedPoint& from, const TimedPoint& to, const std::vector<double>& a,
                    const std::vector<double>& b) {
  const std::size_t leading = leading_joint(a, b);
  const Interval leading_way = Interval(b[leading]) - Interval(a[leading]);
  const Bezier lead = detail::segment_rates(from, to, leading).way;
  const Interval lead_start = Interval(from.positions[leading]) - Interval(a[leading]);
  double greatest = 0.0;
  for (std::size_t joint = 0; joint < a.size(); ++joint) {
    const Bezier way = detail::segment_rates(from, to, joint).way;
    const Interval start = Interval(from.positions[joint]) - Interval(a[joint]);
    const Interval slope = (Interval(b[joint]) - Interval(a[joint])) / leading_way;
    for (std::size_t i = 0; i < way.count; ++i) {
      const Interval off = start + way.b[i] - slope * (lead_start + lead.b[i]);
      greatest = std::max(greatest, off.magnitude());
    }
  }
  return greatest;
}

}  // namespace

TimedMotion stop_motion(const WaypointPath& path, const std::vector<RateLimits>& limits,
                        double share) {
  require_path(path);
  require_limits(path.joint_names, limits);
  const FloatEnvironmentGuard guard;
  const bool has_jerk = any_jerk_limit(limits);
  detail::MotionWriter writer(path, has_jerk);
  for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
    const detail::LineLimits line = detail::line_limits(path, edge, limits, share, has_jerk);
    writer.follow(edge, 0.0, 1.0, detail::line_profile(1.0, 0.0, 0.0, line));
  }
  return writer.take();
}

double deviation_from_edges(const TimedMotion& motion, const WaypointPath& path) {
  require_path(path);
  const FloatEnvironmentGuard guard;
  double greatest = 0.0;
  std::size_t point = 0;
  const auto require_waypoint = [&](std::size_t waypoint) {
    while (point < motion.points.size() &&
           !rests_at(motion.points[point], path.waypoints[waypoint])) {
      ++point;
    }
    if (point == motion.points.size()) {
      throw std::invalid_argument("expected a motion that rests at waypoint " +
                                  std::to_string(waypoint + 1));
    }
    return point;
  };
  std::size_t begin = require_waypoint(0);
  for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
    const std::size_t end = require_waypoint(edge + 1);
    for (std::size_t k = begin; k < end; ++k) {
      greatest = std::max(greatest, deviation_on(motion.points[k], motion.points[k + 1],
                                                 path.waypoints[edge], path.waypoints[edge + 1]));
    }
    begin = end;
  }
  return greatest;
}

}  // namespace firstcontact
