/// @file
/// Writes reports on the joints of a scene's robots: their turns and the limits that they leave.

#pragma once

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Adds "turns", where continuous joints turn, and "limits"; nothing for a scene without robots.
void append_joint_reports(const LoadedScene& loaded, JsonObject& object);

}  // namespace firstcontact::detail
