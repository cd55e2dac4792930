/// @file
/// The data with which a page draws robots and moves them.

#pragma once

#include <span>
#include <string>
#include <vector>

#include <firstcontact/page/detail/page_meshes.h>
#include <firstcontact/page/detail/urdf_colors.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// The robots with links, joints and the exact pieces of their paths (docs/viewer.md).
///
/// @param colors    one for each robot
/// @param warnings  gets a line for each visual geometry that cannot be read and is left out
[[nodiscard]] JsonArray robots_of_page(const RobotScene& scene, std::span<const UrdfColors> colors,
                                       PageMeshes& meshes, std::vector<std::string>& warnings);

/// The motions of bodies that are carried for a while.
[[nodiscard]] JsonArray carried_of_page(const RobotScene& scene);

}  // namespace firstcontact::detail
