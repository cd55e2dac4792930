/// @file
/// A motion that rests at every waypoint and follows the edges exactly.

#pragma once

#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact {

/// Times a path with rest at every waypoint, as fast as the limits allow.
///
/// With a jerk limit each edge has phases of constant jerk, else a trapezoid of velocities. The
/// points are the ends of these phases. A controller's quintic between them, or cubic for the
/// trapezoid, is that motion, except for the rounding of the numbers to doubles. All joints of an
/// edge move in step, so that the geometry is the straight edge.
///
/// Limits hold except for that rounding: rate_report() proves them.
///
/// @param share  share of the limits that may be used, in (0, 1]
/// @throws std::invalid_argument as require_path(), require_limits()
[[nodiscard]] FIRSTCONTACT_API TimedMotion stop_motion(const WaypointPath& path,
                                                       const std::vector<RateLimits>& limits,
                                                       double share = 1.0);

/// [rad or m]  Bounds the distance of any joint from the edges of the path in stop_motion().
///
/// Proven at all times for the controller's interpolation between the motion's points. The motion
/// has to be one of stop_motion() for the same path: each edge lies between two points that are its
/// waypoints.
///
/// @throws std::invalid_argument if a waypoint is not among the points, in order and at rest
[[nodiscard]] FIRSTCONTACT_API double deviation_from_edges(const TimedMotion& motion,
                                                           const WaypointPath& path);

}  // namespace firstcontact
