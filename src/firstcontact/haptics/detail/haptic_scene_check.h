/// @file
/// Refuses invalid haptic scenes.

#pragma once

#include <string>

#include <firstcontact/haptics/haptic_scene.h>

namespace firstcontact::detail {

/// Requires a condition.
///
/// @throws std::invalid_argument with this text unless the condition holds
void require_haptic(bool holds, const std::string& what);

[[nodiscard]] bool is_finite_pose(const Pose& pose);

/// Checks a scene.
///
/// @throws std::invalid_argument that names the tool or the body, if a number is out of its range,
///         there is no tool or too many, or a shape deforms
void check_haptic_scene(const HapticScene& scene);

}  // namespace firstcontact::detail
