/// @file
/// A path as MoveIt's time-optimal retiming may execute it.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact::benchmarks {

/// Returns the samples of a path of the Panda's seven joints that is rounded and retimed.
///
/// Corners become circles that leave the path by at most 0.1 rad. The speed along it is as great as
/// the limits of the joints' velocities and accelerations let it, forward and backward on a grid.
/// Samples are 0.1 s apart. These are the defaults of MoveIt. Its profile also takes the
/// acceleration across and along the path together; here each has the whole limit.
///
/// Source: T. Kunz, M. Stilman, "Time-optimal trajectory generation for path following with bounded
/// acceleration and velocity", RSS 2012, section IV.
[[nodiscard]] std::vector<Configuration> blended_path(const std::vector<Configuration>& waypoints);

}  // namespace firstcontact::benchmarks
