/// @file
/// A scene made ready for queries: meshes loaded, motions normalised, rules for pairs set.

#pragma once

#include <string>

#include <firstcontact/math/export.h>
#include <firstcontact/query/body_set.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>

namespace firstcontact {

/// A scene and all that its queries need.
struct LoadedScene {
  Scene scene;
  BodySet bodies;            ///< In the scene's order; t = time / duration.
  std::string input_digest;  ///< SHA-256 over the digests of the scene's text and its files.
};

/// Loads the meshes of a scene, as far as the cache does not hold them yet.
///
/// @throws ParseError if a mesh file cannot be used; std::invalid_argument if the scene, made by
///         hand, holds what read_scene would refuse
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene(Scene scene, ShapeCache& cache);

}  // namespace firstcontact
