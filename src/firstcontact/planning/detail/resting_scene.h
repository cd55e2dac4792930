/// @file
/// The scene of a plan with its movers at rest at their starts.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {

/// The name of something other than the movers that moves; none where all else rests.
[[nodiscard]] std::optional<std::string> what_moves(const Scene& scene,
                                                    const PlanQuestion& question);

/// Names of the bodies that forces would move in a simulation.
[[nodiscard]] std::vector<std::string> frozen_by_plan(const Scene& scene,
                                                      const PlanQuestion& question);

/// A pose with a quaternion of length 1, as places of a body have it.
///
/// Rounded decimals are scaled. A quaternion of length 1 comes back bit for bit.
[[nodiscard]] Pose with_unit_quaternion(Pose pose);

/// The scene with the movers at rest at their start, and the margin of the question.
///
/// All other bodies rest or move by themselves.
[[nodiscard]] Scene resting_scene(Scene scene, const PlanQuestion& question);

}  // namespace firstcontact::detail
