/// @file
/// The closest pair of all members.

#pragma once

#include <cstddef>
#include <optional>

#include <tbb/enumerable_thread_specific.h>

#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>

namespace firstcontact::detail {

using LinkWorkspaces = tbb::enumerable_thread_specific<LinkWorkspace>;

struct LeastOfAll {
  std::size_t pair = 0;   ///< Index among the tested pairs.
  ClosestApproach least;  ///< Least distance; its lower bound holds for all pairs.
};

/// Two geometries at a time at which they are known to be near each other.
struct KnownNear {
  GeometryCandidate candidate;
  double t = 0.0;
};

/// The least distance of all tested pairs over all pieces in which they are tested; none where no
/// pair is tested.
///
/// It first looks at the nearest geometries of each pair, by the balls around them, and descends
/// from the least distance found. Then it searches for candidates that come nearer, piece by piece,
/// as for contacts. The result of one search holds for the next ones. Several are searched at a
/// time, always so many by the same distance, so that the number of threads changes nothing.
[[nodiscard]] std::optional<LeastOfAll> least_of_all(const RobotTimeline& timeline,
                                                     const CandidateSearch& candidates,
                                                     const std::optional<KnownNear>& known,
                                                     const RobotCheckOptions& options,
                                                     LinkWorkspaces& workspaces);

}  // namespace firstcontact::detail
