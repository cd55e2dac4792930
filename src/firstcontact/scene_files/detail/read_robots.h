/// @file
/// Reads the robots of a scene.

#pragma once

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_path.h>

namespace firstcontact {
struct Scene;
}

namespace firstcontact::detail {

/// Reads "robots" into a scene that has its bodies and whose options state whether it is lenient.
///
/// It reads their URDF and SRDF and trajectories, but no meshes.
///
/// @throws ParseError
void read_robots(const JsonValue& value, const SceneFolders& folders, Scene& scene,
                 const JsonReader& read);

}  // namespace firstcontact::detail
