/// @file
/// Reads the springs, cables and joints between the bodies of a simulation.

#pragma once

#include <vector>

#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/scene/tie.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads the number of a body, or of a link "robot/link".
///
/// @throws ParseError
[[nodiscard]] std::size_t read_member(const JsonValue& value, const SceneNames& names,
                                      const JsonReader& read);

/// Reads "ties" of a simulation.
///
/// @throws ParseError
[[nodiscard]] std::vector<Tie> read_ties(const JsonValue& value, const SceneNames& names,
                                         const JsonReader& read);

}  // namespace firstcontact::detail
