/// @file
/// First contact in a scene.

#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot_check/check_robots.h>
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
  /// The answer of every pair over the whole step, with every interval of contact; for scenes with
  /// robots.
  bool all_contacts_in_time = false;
  int threads = 0;            ///< At most; 0 for one on each core. Answers do not depend on it.
  std::stop_token stop = {};  ///< Ends the check with what is proven so far.
  /// Called with the part that is done, as ManyBodiesOptions::progress.
  std::function<void(double done)> progress = {};
};

/// The answer of a scene. Times are normalised to its duration.
struct SceneResult {
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;                 ///< [-]  No pair is in contact in [0, t): proven. 1 when free.
  std::optional<double> t_upper;  ///< [-]  A time that is proven to be in contact, if one is known.
  double clearance = 0.0;         ///< [m]  Proven lower bound of every pair's distance up to t;
                                  ///<      infinite where no pair is tested.
  double tolerance_used = 0.0;    ///< [m]  The greatest of the pairs that were searched.

  /// The index into `pairs` of the pair that decides `t`: the earliest, ties by their order. None
  /// when free.
  std::optional<std::size_t> first;
  /// The index into `pairs` of the pair that comes closest, where that was asked.
  std::optional<std::size_t> closest;
  /// Every tested pair where that was asked, else those that decide `t`; by the order of bodies.
  std::vector<PairAnswer> pairs;
  WorkCount work;  ///< Of all pairs that were searched.

  /// The answer of a scene with robots, by members; then `first`, `closest` and `pairs` are empty.
  std::optional<RobotCheckResult> robots = {};
};

/// [m]  The proven lower bound of a pair's distance before its `t`.
[[nodiscard]] FIRSTCONTACT_API double proven_clearance(const RobotPairAnswer& pair);

/// Answers a scene by the first contact of its bodies and robots, or by that of every pair over the
/// whole step.
///
/// The scene's deadline starts with this call; loading does not count. A pair that the deadline
/// or the stop token keeps from being asked is undecided. Deterministic without either.
///
/// @throws std::invalid_argument if an option of the scene is outside its range, or not for scenes
///         with (without) robots
[[nodiscard]] FIRSTCONTACT_API SceneResult check_scene(const LoadedScene& loaded,
                                                       ManyBodiesWorkspace& workspace,
                                                       const CheckOptions& options = {});

/// The warnings that an answer needs: those of loading, that no pair is tested, that free bodies
/// rest in it.
[[nodiscard]] FIRSTCONTACT_API std::vector<std::string> check_warnings(const LoadedScene& loaded);

}  // namespace firstcontact
