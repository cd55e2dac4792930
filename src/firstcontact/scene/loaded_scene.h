/// @file
/// A scene made ready for queries: meshes loaded, motions normalised, pairs listed.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>

namespace firstcontact {

/// Two bodies of a scene that are tested against each other.
struct ScenePair {
  BodyPair bodies;
  double margin = 0.0;  ///< [m]  The pair's own, or else the scene's.
};

/// A scene and all that its queries need.
struct LoadedScene {
  Scene scene;
  std::vector<Shape> shapes;     ///< Of each body.
  std::vector<Motion> motions;   ///< Of each body, t = time / duration.
  std::vector<ScenePair> pairs;  ///< All that are not ignored, in the order of the bodies.
  std::string input_digest;      ///< SHA-256 over the digests of the scene's text and its files.

  /// A body as the queries take it; refers to this.
  [[nodiscard]] MovingShape moving_shape(std::size_t body) const {
    return {shapes[body], motions[body]};
  }
};

/// Loads the meshes of a scene, as far as the cache does not hold them yet.
///
/// @throws ParseError if a mesh file cannot be used; std::invalid_argument if the scene, made by
///         hand, holds what read_scene would refuse
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene(Scene scene, ShapeCache& cache);

}  // namespace firstcontact
