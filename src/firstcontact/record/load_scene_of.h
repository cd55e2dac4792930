/// @file
/// The scene of a recorded run, with the files that it was made of.

#pragma once

#include <firstcontact/math/export.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

class ShapeCache;
struct RunHeader;

/// Loads the scene of a run, with its meshes and robots.
///
/// @throws std::invalid_argument if a file has changed since the run was made: the digest of all
///         files differs from that of the header. An empty digest there is unknown.
/// @throws as load_scene
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene_of(const RunHeader& header,
                                                         ShapeCache& cache);

}  // namespace firstcontact
