/// @file
/// The goals of a plan that are poses of links.

#pragma once

#include <stop_token>

#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/plan_question.h>

namespace firstcontact::detail {

/// Adds the goals that are poses of links, and the time that this takes to `options.spent`.
///
/// Poses take turns, one try of inverse kinematics each, within the time of the question. Places
/// that are not free are passed over. The search ends once it has eight free places in all. With
/// some goal it also ends after half of the time, or once many tries brought no other place. A pose
/// without a free place is a warning where another goal is left.
///
/// @param plan  has its start, and goals that are positions of joints
/// @param stop  ends the search; there may be no goal then
/// @throws std::invalid_argument if the start is not free, or no goal is left
void add_link_goals(ScenePlan& plan, const PlanQuestion& question, const std::stop_token& stop);

}  // namespace firstcontact::detail
