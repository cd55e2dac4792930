/// @file
/// A motion that passes waypoints on blends in place of resting at them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact {

/// [-]  The greatest share of an edge that a blend may take; two blends leave a tenth between them.
inline constexpr double kLongestBlend = 0.45;

/// [rad or m]  A blend may leave the path by any distance.
inline constexpr double kAnyDeviation = std::numeric_limits<double>::infinity();

/// The blend about one waypoint: from the edge before it to the edge behind it.
///
/// It is a polynomial of degree 4 in time. Its velocity turns from one edge's to the other's, with
/// accelerations of 0 at both ends. It stays in the triangle of its ends and the waypoint.
struct Blend {
  double before = 0.0;     ///< [-]  Share of the edge before the waypoint; 0 where the robot rests
                           ///< there.
  double after = 0.0;      ///< [-]  Share of the edge behind it.
  std::int64_t begin = 0;  ///< [ns]
  std::int64_t end = 0;    ///< [ns]  As `begin` where the robot rests.
};

/// A motion with its blends, one for each waypoint between the ends.
struct BlendedMotion {
  TimedMotion motion = {};
  std::vector<Blend> blends = {};
};

/// Times a path with blends about the waypoints, each as long as makes the motion fastest.
///
/// Derivation: a blend of time T from velocity u to velocity w has the position
///   p + T (u s + (w - u) (s^3 - s^4 / 2)),  s in [0, 1].
/// Its velocity is between u and w. Its acceleration is at most 1.5 |w - u| / T, and its jerk at
/// most 6 |w - u| / T^2. The controller's quintic between the two ends of a blend is this
/// polynomial. Between the blends the motion follows the edges with phases of constant jerk.
///
/// A heuristic chooses the lengths: waypoint by waypoint, as long as one change makes the motion
/// faster. Geometry and limits do not depend on it. A joint without a jerk limit gets one on the
/// edges: its acceleration builds up in 10 ms.
///
/// The distance of a blend from the edges is at most 3/16 |T (w - u) / 2| in each joint.
/// Derivation: compare it with the motion that goes on at u to the waypoint, and then at w. The two
/// differ by T (w - u) (s^3 - s^4 / 2) before the waypoint. That is greatest at s = 1/2. Behind the
/// waypoint it is the same, by symmetry.
///
/// @param longest    greatest blend at each waypoint between the ends, a share of both edges in
///                   [0, kLongestBlend]; 0: the robot rests there
/// @param share      share of the limits that may be used, in (0, 1]
/// @param deviation  [rad or m]  greatest distance of a blend from the path, in each joint; >= 0
/// @throws std::invalid_argument as require_path(), require_limits()
[[nodiscard]] FIRSTCONTACT_API BlendedMotion blend_motion(const WaypointPath& path,
                                                          const std::vector<RateLimits>& limits,
                                                          const std::vector<double>& longest,
                                                          double share = 1.0,
                                                          double deviation = kAnyDeviation);

}  // namespace firstcontact
