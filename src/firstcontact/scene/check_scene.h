/// @file
/// First contact in a scene.

#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/math/export.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

/// The options of a check.
struct CheckOptions {
  bool all_pairs = false;  ///< Answers every pair over the whole step.
  /// Computes the closest approach.
  ///
  /// In scenes of bodies every pair is answered over the whole step, with its closest approach. In
  /// scenes with robots it is that of all pairs, and of each pair only with all_pairs or
  /// all_contacts_in_time.
  bool closest = false;
  bool all_contacts_in_time = false;  ///< Answers every pair likewise, with all of its intervals of
                                      ///< contact.
  int threads = 0;            ///< At most; 0 for one on each core. Answers do not depend on it.
  std::stop_token stop = {};  ///< Ends the check with what is proven so far.
  /// Called now and then from the calling thread with a number in [0, 1]; may be empty.
  ///
  /// Where each pair is answered, the number is the share that is done. Else it is the time that is
  /// proven free so far.
  std::function<void(double done)> progress = {};
};

/// Answers a scene by the first contact of its bodies and robots, or by that of every pair over the
/// whole step.
///
/// The scene's deadline starts with this call; loading does not count. A pair that the deadline or
/// the stop token leaves untested is undecided. Without either the answer is deterministic.
///
/// @returns times normalised to the duration of the scene; members are numbered as in it
/// @throws std::invalid_argument if an option of the scene is outside its range, or not for scenes
///         with robots
[[nodiscard]] FIRSTCONTACT_API SceneResult check_scene(const LoadedScene& loaded,
                                                       ManyBodiesWorkspace& workspace,
                                                       const CheckOptions& options = {});

/// Whether a check answers every pair over the whole step, rather than to end at the first contact.
[[nodiscard]] FIRSTCONTACT_API bool answers_each_pair(const LoadedScene& loaded,
                                                      const CheckOptions& options);

/// The warnings that an answer needs: those of loading, that no pair is tested, that free bodies
/// rest.
[[nodiscard]] FIRSTCONTACT_API std::vector<std::string> check_warnings(const LoadedScene& loaded);

}  // namespace firstcontact
