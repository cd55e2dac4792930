/// @file
/// Reads the motion of a body.

#pragma once

#include <firstcontact/scene/body_motion.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads `type` (fixed, constant_velocity, screw, waypoints) and the numbers of that motion.
///
/// @throws ParseError
[[nodiscard]] BodyMotion read_motion(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
