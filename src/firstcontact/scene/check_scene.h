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

struct CheckOptions {
  bool all_pairs = false;  ///< The answer of every pair over the whole step.
  /// The closest approach.
  ///
  /// In scenes of bodies: also the answer of every pair over the whole step, with the closest
  /// approach of each. In scenes with robots: that of all pairs, and of each only with all_pairs or
  /// all_contacts_in_time.
  bool closest = false;
  bool all_contacts_in_time = false;  ///< So too, with every interval of contact of each pair.
  int threads = 0;            ///< At most; 0 for one on each core. Answers do not depend on it.
  std::stop_token stop = {};  ///< Ends the check with what is proven so far.
  /// Called now and then from the calling thread with a number in [0, 1]; may be empty. Where each
  /// pair is answered, that is the share that is done, else the time that is proven free so far.
  std::function<void(double done)> progress = {};
};

/// Answers a scene by the first contact of its bodies and robots, or by that of every pair over the
/// whole step.
///
/// The scene's deadline starts with this call; loading does not count. A pair that the deadline
/// or the stop token keeps from being asked is undecided. Deterministic without either.
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
/// rest in it.
[[nodiscard]] FIRSTCONTACT_API std::vector<std::string> check_warnings(const LoadedScene& loaded);

}  // namespace firstcontact
