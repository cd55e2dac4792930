/// @file
/// Reads the dynamics of a robot in a simulation.

#pragma once

#include <firstcontact/scene/simulation.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct SceneRobot;
}

namespace firstcontact::detail {

/// Reads the dynamics of a robot.
///
/// @param robot  with its model and its trajectory
/// @throws ParseError
[[nodiscard]] RobotDynamics read_robot_dynamics(const JsonValue& value, const SceneRobot& robot,
                                                const JsonReader& read);

}  // namespace firstcontact::detail
