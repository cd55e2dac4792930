/// @file
/// A path with fewer waypoints, within a tolerance of the given one.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact::detail {

/// The waypoint that is farthest from the edge between two others.
struct FarthestWaypoint {
  std::size_t waypoint = 0;
  double deviation = 0.0;  ///< [rad or m]  Of the joint that is off most; 0 where none is between.
};

/// Measures how far an edge between two waypoints leaves the path between them.
///
/// Each waypoint is compared with its projection onto the edge; projections never go back. So the
/// edge passes all waypoints in their order, each within the deviation in every joint. As both are
/// linear in between, the path between the two waypoints is that near, too.
[[nodiscard]] FarthestWaypoint farthest_from_edge(const WaypointPath& path, std::size_t first,
                                                  std::size_t last);

/// The waypoints that are kept, in order: both ends, and those that the tolerance needs.
///
/// An edge that leaves the path by more is divided at its farthest waypoint.
///
/// Source: D. Douglas, T. Peucker, "Algorithms for the reduction of the number of points required
/// to represent a digitized line or its caricature", Cartographica 10 (1973).
///
/// @param tolerance  [rad or m]  for each joint; >= 0
/// @param kept       waypoints that stay in any case, in order
[[nodiscard]] std::vector<std::size_t> thinned_waypoints(const WaypointPath& path, double tolerance,
                                                         const std::vector<std::size_t>& kept);

/// The path through some waypoints of another one.
[[nodiscard]] WaypointPath through_waypoints(const WaypointPath& path,
                                             const std::vector<std::size_t>& kept);

/// [rad or m]  The greatest distance between two positions of a joint on the path.
[[nodiscard]] double extent_of(const WaypointPath& path);

/// Whether the way turns back at a waypoint: by more than 170 degrees.
///
/// A motion that passes there on a blend gains little, and misses the waypoint by far.
[[nodiscard]] bool turns_back(const WaypointPath& path, std::size_t waypoint);

}  // namespace firstcontact::detail
