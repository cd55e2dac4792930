/// @file
/// The fastest motion that the limits allow along the geometry of a blended motion.

#pragma once

#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/blend_motion.h>

namespace firstcontact {

/// Times the geometry of a blended motion anew, nearly time-optimally.
///
/// Between two rests the phase plane of velocity and acceleration gives the fastest motion on a
/// grid. It is averaged over a short window of time, so that its jerk is bounded. Quintics join the
/// points on it, and leave the geometry a little between the points. Then all times are stretched
/// until the limits hold, by the bounds of rate_report(). Several windows are tried, and the
/// fastest motion is taken. It is never slower than the blended motion. Windows are longer where
/// edges take seconds, so that the number of points is bounded by that of the edges.
///
/// Limits hold except for the rounding of the numbers to doubles: rate_report() proves them.
///
/// @param blended  a result of blend_motion(), for the same path and limits
/// @param share    share of the limits that may be used, in (0, 1]
[[nodiscard]] FIRSTCONTACT_API BlendedMotion
time_optimal_motion(const BlendedMotion& blended, const WaypointPath& path,
                    const std::vector<RateLimits>& limits, double share = 1.0);

}  // namespace firstcontact
