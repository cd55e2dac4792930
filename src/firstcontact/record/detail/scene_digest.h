/// @file
/// The digest of the scene in the header of a run.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::detail {

/// The SHA-256 of a scene in JSON, without spaces.
[[nodiscard]] std::string digest_of_scene(std::string_view scene);

/// The digest of the scene in a header line.
///
/// @param line  one JSON object with the key "scene"
[[nodiscard]] std::string digest_of_scene_in(std::string_view line);

}  // namespace firstcontact::detail
