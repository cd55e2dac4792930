/// @file
/// How a check is asked about edges.

#pragma once

#include <span>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// Whether each member moves along edges: it is a link of the mover that a coordinate of the space
/// moves, or a body that such a link holds. Where the surroundings move, every link of the mover
/// counts.
[[nodiscard]] std::vector<bool> moved_members(const PlanScene& plan);

/// The scene in which edges are checked: all pairs keep an extra distance, and pairs that no edge
/// moves are not tested.
[[nodiscard]] RobotScene scene_of_edges(const PlanScene& plan, double extra);

/// The same without pairs that are held.
[[nodiscard]] RobotScene scene_of_edges(const PlanScene& plan, double extra,
                                        std::span<const HeldPair> held);

/// The scene in which held pairs alone are tested, with their distances for margins, and no more
/// than `extra` and their tolerances beyond.
[[nodiscard]] RobotScene scene_of_held(const PlanScene& plan, double extra,
                                       std::span<const HeldPair> held);

/// The question of a check with the options of edges.
[[nodiscard]] RobotCheckOptions question_of_edges(const EdgeCheckOptions& options);

/// The same for held pairs.
[[nodiscard]] RobotCheckOptions question_of_held(const EdgeCheckOptions& options);

}  // namespace firstcontact::detail
