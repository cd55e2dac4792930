/// @file
/// The matrix of a planning scene that states which pairs may touch.

#pragma once

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads a moveit_msgs/AllowedCollisionMatrix.
[[nodiscard]] AllowedCollisions read_allowed_collisions(const JsonValue& matrix,
                                                        const JsonReader& read);

}  // namespace firstcontact::detail
