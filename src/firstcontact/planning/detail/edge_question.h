/// @file
/// How a check is asked about edges.

#pragma once

#include <firstcontact/planning/edge_checker.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// The scene in which edges are checked: all pairs keep an extra distance, and pairs that no edge
/// moves are not tested.
///
/// Those are the pairs of members without a link of the mover that a coordinate of the space moves,
/// and without a body that such a link holds. Where the surroundings move, every link of the mover
/// counts as moved.
[[nodiscard]] RobotScene scene_of_edges(const PlanScene& plan, double extra);

/// The question of a check with the options of edges.
[[nodiscard]] RobotCheckOptions question_of_edges(const EdgeCheckOptions& options);

}  // namespace firstcontact::detail
