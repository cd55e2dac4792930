/// @file
/// Makes a scene with robots ready for queries.

#pragma once

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact::detail {

/// The rules for pairs of a scene, by members.
[[nodiscard]] PairRules rules_of(const Scene& scene);

/// Loads the meshes of bodies and robots, sets their motions, and reports what is unusual.
///
/// @throws as load_scene
[[nodiscard]] LoadedScene load_robots(Scene scene, ShapeCache& cache);

}  // namespace firstcontact::detail
