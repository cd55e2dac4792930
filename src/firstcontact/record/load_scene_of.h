/// @file
/// The scene of a recorded run, with the files that it was made of.

#pragma once

#include <firstcontact/math/export.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

class ShapeCache;
struct RunHeader;

/// Reads the meshes and robots that a run's scene names.
///
/// @throws std::invalid_argument if one of them is not what it was when the run was made: the
///     digest of everything read differs from that of the header (which may be empty: unknown).
/// @throws as load_scene
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene_of(const RunHeader& header,
                                                         ShapeCache& cache);

}  // namespace firstcontact
