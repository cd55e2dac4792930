/// @file
/// First contact in a scene: every pair of bodies is asked, the earliest answers for all.

#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

struct CheckOptions {
  bool closest = false;       ///< Also the closest approach of every pair.
  std::stop_token stop = {};  ///< Ends the check with what is proven so far.
  /// Called before each pair with its number; may be empty.
  std::function<void(std::size_t pair)> progress = {};
};

/// What one pair of bodies answered.
struct PairResult {
  BodyPair bodies;
  FirstContactResult first_contact;
  std::optional<ClosestApproachResult> closest_approach;
};

/// The answer of a scene. Times are normalised to its duration.
struct SceneResult {
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;                 ///< [-]  No pair is in contact in [0, t): proven. 1 when free.
  std::optional<double> t_upper;  ///< [-]  A time that is proven to be in contact, if one is known.
  double clearance = 0.0;         ///< [m]  Proven lower bound of every pair's distance up to t;
                                  ///<      infinite where no pair is tested.
  double tolerance_used = 0.0;    ///< [m]  The greatest of the pairs.

  /// Index into `pairs` of the one that decides `t`: the earliest, ties by their order. None when
  /// free.
  std::optional<std::size_t> first;
  /// Index into `pairs` of the one that comes closest, where that was asked.
  std::optional<std::size_t> closest;
  std::vector<PairResult> pairs;  ///< As LoadedScene::pairs.
  WorkCount work;                 ///< Of all pairs.
};

/// Answers a scene by asking every pair for its first contact over the whole step.
///
/// The scene's deadline starts with this call; loading does not count. A pair that the deadline
/// or the stop token keeps from being asked is undecided at t = 0. Deterministic without either.
///
/// @throws std::invalid_argument if an option of the scene is outside its range
[[nodiscard]] FIRSTCONTACT_API SceneResult check_scene(const LoadedScene& loaded,
                                                       Workspace& workspace,
                                                       const CheckOptions& options = {});

}  // namespace firstcontact
