/// @file
/// Reads the haptics of a scene.

#pragma once

#include <firstcontact/scene/haptic_question.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Reads "haptics" of a scene that has its bodies.
///
/// @throws ParseError
[[nodiscard]] HapticQuestion read_haptics(const JsonValue& value, const Scene& scene,
                                          const JsonReader& read);

}  // namespace firstcontact::detail
