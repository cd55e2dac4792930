/// @file
/// The scene and the options of a check of edges.

#pragma once

#include <span>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// Finds which members move along edges: the links of a mover that a coordinate of the space moves,
/// and the bodies that such links hold. In an environment that moves, every link of the mover
/// counts.
[[nodiscard]] std::vector<bool> moved_members(const PlanScene& plan);

/// Makes the scene in which edges are checked: all pairs keep an extra distance, and pairs that no
/// edge moves are not tested.
[[nodiscard]] RobotScene scene_of_edges(const PlanScene& plan, double extra);

/// Makes the same scene without the pairs that are held.
[[nodiscard]] RobotScene scene_of_edges(const PlanScene& plan, double extra,
                                        std::span<const HeldPair> held);

/// Makes the scene in which only held pairs are tested. Their margins are their distances, plus
/// `extra` or their tolerances, whichever is less.
[[nodiscard]] RobotScene scene_of_held(const PlanScene& plan, double extra,
                                       std::span<const HeldPair> held);

/// Makes the options of a check from those of edges.
[[nodiscard]] RobotCheckOptions question_of_edges(const EdgeCheckOptions& options);

/// Makes the options of a check of held pairs.
[[nodiscard]] RobotCheckOptions question_of_held(const EdgeCheckOptions& options);

}  // namespace firstcontact::detail
