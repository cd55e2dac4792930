/// @file
/// Writes a motion along the straight edges of a path, point by point.

#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <firstcontact/retiming/detail/line_profile.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact::detail {

/// Time in which accelerations build up where the motion needs a jerk limit and no joint has one.
inline constexpr double kBuildUpTime = 0.01;  // [s]

/// The limits of x on the edge from waypoint `edge` to the next, q = a + x (b - a).
///
/// @param share       share of the limits that may be used, in (0, 1]
/// @param needs_jerk  whether an edge whose joints have no jerk limit gets one by kBuildUpTime
[[nodiscard]] LineLimits line_limits(const WaypointPath& path, std::size_t edge,
                                     const std::vector<RateLimits>& limits, double share,
                                     bool needs_jerk);

/// Appends points to a motion.
class MotionWriter {
 public:
  /// Begins at rest at the first waypoint.
  MotionWriter(const WaypointPath& path, bool with_accelerations);

  /// Appends the nodes of a profile that runs from x = `from` to x = `to` of an edge.
  void follow(std::size_t edge, double from, double to, const std::vector<LineNode>& nodes);

  /// Appends a point. Without accelerations the point's are left out.
  void add(std::int64_t after, TimedPoint point);

  /// The state of all joints on an edge. At x = 0 and x = 1 it is the waypoint to the bit.
  [[nodiscard]] TimedPoint on_edge(std::size_t edge, const LineState& state) const;

  /// [ns]  Time of the last point.
  [[nodiscard]] std::int64_t now() const { return motion_.points.back().time; }

  [[nodiscard]] TimedMotion take() { return std::move(motion_); }

 private:
  const WaypointPath& path_;
  bool with_accelerations_;
  TimedMotion motion_;
};

}  // namespace firstcontact::detail
