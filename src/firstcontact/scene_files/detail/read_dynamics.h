/// @file
/// Reads the dynamics of a body: the properties that it needs to move under forces.

#pragma once

#include <firstcontact/scene/simulation.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct Body;
}

namespace firstcontact::detail {

/// Reads `dynamics` of a body without a motion: its `free` and `surface`.
///
/// @throws ParseError
void read_dynamics(const JsonValue& value, Body& body, const JsonReader& read);

/// Reads `friction` and `restitution`, where they are given.
///
/// @throws ParseError
[[nodiscard]] Surface read_surface(const JsonObject& object, const JsonReader& read);

/// Reads a number in [0, 1].
///
/// @throws ParseError
[[nodiscard]] double read_restitution(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
