/// @file
/// A path with fewer waypoints whose straight edges are proven free.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact::detail {

/// Leaves out waypoints within a tolerance, as far as the new edges are free.
///
/// An edge that is in contact or undecided is divided at its farthest waypoint, until it is free or
/// one of the given path. Edges of the given path are not proven anew.
///
/// @param tolerance  [rad or m]  as thinned_waypoints()
/// @param kept       waypoints that stay in any case, in order
/// @returns          the waypoints that are left, in order
[[nodiscard]] std::vector<std::size_t> free_thinning(const WaypointPath& path,
                                                     const std::vector<RateLimits>& limits,
                                                     const RetimingScene& where,
                                                     const ProofOptions& options, double tolerance,
                                                     const std::vector<std::size_t>& kept);

}  // namespace firstcontact::detail
