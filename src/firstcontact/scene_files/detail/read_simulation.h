/// @file
/// Reads the settings of a simulation.

#pragma once

#include <firstcontact/scene/simulation.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Reads "simulation" of a scene that has its bodies, robots and groups.
///
/// A duration that is not given stays at its default.
///
/// @throws ParseError
[[nodiscard]] Simulation read_simulation(const JsonValue& value, const Scene& scene,
                                         const JsonReader& read);

}  // namespace firstcontact::detail
