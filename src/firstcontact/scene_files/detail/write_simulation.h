/// @file
/// Writes the settings of a simulation.

#pragma once

#include <firstcontact/text/json_tree.h>

namespace firstcontact {
struct Body;
struct Scene;
struct SceneRobot;
}  // namespace firstcontact

namespace firstcontact::detail {

/// Adds `dynamics` of a free body, or `surface` of another body that has one.
void add_dynamics(const Body& body, JsonObject& object);

/// Writes the dynamics of a robot.
///
/// @param robot  has dynamics
[[nodiscard]] JsonValue robot_dynamics_to_json(const SceneRobot& robot);

/// Writes the settings of a simulation.
///
/// @param scene  has a simulation
[[nodiscard]] JsonValue simulation_to_json(const Scene& scene);

}  // namespace firstcontact::detail
