/// @file
/// Names of joints and links of one or several robots of a scene.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// The name of a joint or link, and its robot.
struct RobotName {
  std::size_t which = 0;  ///< Index among the given robots.
  std::string name;       ///< Name in that robot.
};

/// Splits a name: that of a joint or link where there is one robot, else ROBOT/NAME.
///
/// @param robots  indices of the scene's robots; at least one
/// @throws std::invalid_argument  names a text that begins with none of the robots' names, or with
///         two
[[nodiscard]] RobotName split_robot_name(const Scene& scene, std::span<const std::size_t> robots,
                                         std::string_view name);

}  // namespace firstcontact::detail
