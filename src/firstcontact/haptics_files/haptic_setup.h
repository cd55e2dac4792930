/// @file
/// The haptic session that a scene file describes.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

class ShapeCache;
struct LoadedScene;
struct Scene;

/// A session, and the body of the scene that each of its members is.
struct HapticSetup {
  HapticScene scene = {};
  HapticSessionOptions options = {};
  /// The bodies of the tools, then of the others, then of the links that grips move.
  std::vector<std::size_t> bodies = {};
};

/// Prepares a scene with "haptics" for the record of a session of this length.
///
/// Its tools become free bodies; its simulation has the steps of the contact loop. Robots that rest
/// become bodies, each of one mesh. Each link of a tool with grips becomes a body.
///
/// @param duration  [s]  > 0; motions of other bodies go on as in set_simulation_duration()
/// @param latency   [s]  >= 0  of the contact loop in virtual time: its steps are at least as long
/// @throws std::invalid_argument if the scene has no "haptics", robots that move or hold a body,
///         bodies that other things move (dynamics, vertices), margins; or the duration is not > 0
/// @throws as load_scene, where there are robots
FIRSTCONTACT_API void prepare_haptics(Scene& scene, ShapeCache& cache, double duration,
                                      double latency = 0.0);

/// Makes the session of a scene.
///
/// @param loaded  of a scene that was prepared
/// @throws std::invalid_argument as ContactLoop
[[nodiscard]] FIRSTCONTACT_API HapticSetup haptic_setup(const LoadedScene& loaded);

}  // namespace firstcontact
