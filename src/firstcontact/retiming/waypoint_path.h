/// @file
/// A path without times: configurations of a robot, and straight edges between them.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact {

/// Straight edges in the space of joint coordinates. All coordinates of an edge move at the same
/// time.
struct WaypointPath {
  std::vector<std::string> joint_names = {};  ///< As trajectories name coordinates, each once.
  /// [rad or m]  Two or more, each with a number for every name; neighbours differ.
  std::vector<std::vector<double>> waypoints = {};
};

/// Refuses a path that makes no sense.
///
/// @throws std::invalid_argument  names the waypoint, counted from 1: there is only one, it repeats
///         the one before, or has a wrong count of numbers, NaN, or one beyond 1e8 in size
FIRSTCONTACT_API void require_path(const WaypointPath& path);

/// The path with the turns of coordinates that go the short way taken into its numbers.
///
/// A controller turns as the numbers go. Each such number is the one before it plus the way of at
/// most half a turn, rounded to the nearest double.
///
/// @param turns_short  whether each joint name goes the short way; only continuous joints and the
///                     angles of planar ones do
[[nodiscard]] FIRSTCONTACT_API WaypointPath unwound(WaypointPath path,
                                                    const std::vector<bool>& turns_short);

}  // namespace firstcontact
