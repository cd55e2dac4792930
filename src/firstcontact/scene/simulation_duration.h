/// @file
/// The time for which a scene is simulated.

#pragma once

#include <cstddef>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct Scene;
struct Simulation;

/// Sets the time for which a scene is simulated.
///
/// Scripted bodies and bases of robots keep their rates. A run may end before they do. In a longer
/// run constant velocities and screws go on, and a body that moves between two poses rests at the
/// second.
///
/// @param duration  [s]  > 0
/// @throws std::invalid_argument if there is no simulation, the duration is not > 0, or a body
///         would deform for longer than the duration of the scene; the scene is as it was then
FIRSTCONTACT_API void set_simulation_duration(Scene& scene, double duration);

/// The number of steps of a duration, the last one rounded up.
///
/// Rounding adds no step to a duration of whole steps.
[[nodiscard]] FIRSTCONTACT_API std::size_t simulation_step_count(const Simulation& simulation);

}  // namespace firstcontact
