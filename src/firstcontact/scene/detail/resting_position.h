/// @file
/// The position of a robot's joint at rest in its scene.

#pragma once

#include <string_view>

#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact::detail {

/// [rad or m]  The position that the robot's state has for a coordinate; the default one where the
/// state does not name it.
///
/// @param name  the coordinate as trajectories call it
/// @throws std::invalid_argument as find_coordinate()
[[nodiscard]] inline double resting_position(const SceneRobot& robot, std::string_view name) {
  const JointCoordinate which = find_coordinate(robot.model, name);
  const auto found = robot.state.find(coordinate_name(robot.model, which));
  return found != robot.state.end()
             ? found->second
             : default_position(robot.model.joints()[which.joint], which.index);
}

}  // namespace firstcontact::detail
