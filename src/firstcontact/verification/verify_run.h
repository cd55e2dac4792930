/// @file
/// Proves of a recorded run that no pair of bodies ever interpenetrated, frames or not.

#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/verification/proof_verdict.h>

namespace firstcontact {

struct RunHeader;

/// The options of a second proof of a run.
struct VerifyRunOptions {
  /// [m]  > 0  The most by which a scripted body may be off its motion in the scene at the end of a
  /// step.
  ///
  /// Within steps, and where one ended early, the contact distance is added.
  double scripted_tolerance = 1e-6;
  std::size_t work = 20'000'000;  ///< Most tests of two boxes or triangles for one pair and one
                                  ///< step.
  int threads = 0;                ///< At most; 0 for one on each core. The answer is the same.
  std::stop_token stop = {};      ///< Ends the proof with what is proven so far.
  std::function<void(double)> progress = {};  ///< Called with the proven time [s].
};

/// Two bodies at a moment of a run.
struct RunMoment {
  std::size_t step = 0;  ///< From 1.
  double time = 0.0;     ///< [s]  Since the run began.
  BodyPair bodies = {};
  double distance = 0.0;  ///< [m]  Upper bound of their distance.
};

/// The answer of a second proof of a run.
struct RunVerification {
  ProofVerdict verdict = ProofVerdict::not_proven;
  std::string problem;    ///< One sentence; empty where the run is proven.
  std::size_t steps = 0;  ///< Number of verified steps; those up to the problem where there is one.
  double time = 0.0;      ///< [s]  Time at the end of these steps.
  double time_lost = 0.0;       ///< [s]  Time lost in all of them.
  double least_distance = 0.0;  ///< [m]  Proven for these steps; infinite where no pair can touch.
  std::optional<RunMoment> closest;     ///< The moment at which bodies come about as close as that.
  std::optional<RunMoment> problem_at;  ///< The moment that is refuted or not proven.
  double greatest_jump = 0.0;           ///< [m]  From the end of a piece to the begin of the next.
  /// [m]  Bound of the distance of any point of a scripted body from its place in the scene's
  /// motion.
  ///
  /// It holds at any time. Where a body is behind, its place is the one of so much earlier. Steps
  /// in which a body waited, or its script came by, count at their end alone.
  double scripted_deviation = 0.0;
  /// [s]  The most by which a scripted body is behind its motion.
  ///
  /// It waited rather than crush an obstacle.
  double greatest_behind = 0.0;
  /// The pairs that the proof is about: one of the two is free, or a link of a robot.
  PairCounts pair_counts = {};
  std::vector<std::string> warnings = {};  ///< Warnings of reading the scene's files.
};

/// Proves a run, with other code than that which simulates.
///
/// The proof is about the exact motions that the recorded doubles define, with all of its own
/// roundings included. It covers all of each step, for each two bodies that may touch if one of
/// them is free and one moves. A promise counts as kept when the distance is proven to be above 0.
/// It also has to be above the promise less 2^-20 of it and less twice the rounding. From the end
/// of a piece to the begin of the next a pose may differ by 2^-44 of its numbers. The proof covers
/// this difference. The start is tested for bodies that begin inside a solid.
///
/// Method: windows of time cover the step. In each of them every two triangles are shown to be
/// apart along some direction; windows are halved until they are.
///
/// @param next  the steps, one after another; none at the end
/// @throws std::invalid_argument if an option is out of its range, or the scene has robots or
///         bodies whose vertices move; what `next` throws
/// @throws ParseError if a mesh cannot be loaded
[[nodiscard]] FIRSTCONTACT_API RunVerification
verify_run(const RunHeader& header, const std::function<std::optional<RunStep>()>& next,
           const VerifyRunOptions& options = {});

}  // namespace firstcontact
