/// @file
/// Reads the rules for pairs of bodies: which are tested, and with what margins.

#pragma once

#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Reads "pairs" into a scene that has its bodies.
void read_pairs(const JsonValue& value, Scene& scene, const JsonReader& read);

}  // namespace firstcontact::detail
