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

/// `dynamics` of a free body, `surface` of another one that has any.
void add_dynamics(const Body& body, JsonObject& object);

/// @param robot  has dynamics
[[nodiscard]] JsonValue robot_dynamics_to_json(const SceneRobot& robot);

/// @param scene  has a simulation
[[nodiscard]] JsonValue simulation_to_json(const Scene& scene);

}  // namespace firstcontact::detail
