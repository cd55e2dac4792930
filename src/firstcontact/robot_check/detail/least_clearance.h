/// @file
/// The least distance of two members.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/swept_ball.h>

namespace firstcontact::detail {

/// The balls around each geometry throughout each piece of time.
using BallsOfPieces = std::vector<std::vector<SweptBall>>;

/// The least distance of a tested pair over all pieces in which it is tested.
///
/// Pieces are taken in the order of the bounds by their balls. Looks at the middle of the first
/// pieces, samples and descent find a distance. A first contact with a margin of that distance less
/// the tolerance proves it, or finds a lesser one. Where the budget ends the search, the balls
/// bound the rest.
[[nodiscard]] ClosestApproach least_clearance_of(const RobotTimeline& timeline,
                                                 const BallsOfPieces& balls, std::size_t pair,
                                                 const RobotCheckOptions& options,
                                                 LinkWorkspace& workspace);

}  // namespace firstcontact::detail
