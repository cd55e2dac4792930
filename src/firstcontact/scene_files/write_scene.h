/// @file
/// Writes a scene as the JSON that read_scene reads.

#pragma once

#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct Scene;

/// Writes the resolved scene as one JSON object on one line.
///
/// Poses are written as position and quaternion, with every default. Inline meshes are embedded.
/// Mesh files are named by their path as opened.
///
/// Numbers are the shortest that read back to the same double. With a source in the working
/// directory parse_scene() gives the same scene bit for bit, except for its text digest.
[[nodiscard]] FIRSTCONTACT_API std::string write_scene(const Scene& scene);

}  // namespace firstcontact
