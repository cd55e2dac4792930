/// @file
/// The verifier's proof for one pair of bodies and one step.
///
/// Windows of time cover the whole step. In each of them every two triangles are separated along
/// some direction. A curved body takes part as the exact convex set that it is.

#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>

#include <firstcontact/separation/detail/box_tree.h>
#include <firstcontact/separation/detail/covered_motion.h>

namespace firstcontact::detail {

struct RoundSet;

struct CoverBody {
  const BoxTree& tree;  ///< Of a curved body: one box around it, without triangles.
  /// Motions one after another, over the whole time of the proof.
  std::span<const CoveredMotion* const> pieces;
  double thickness = 0.0;  ///< [m]  Thickness of the shape around its triangles.
  double jump = 0.0;       ///< [m]  Greatest jump between the end of a piece and the next begin.
  /// The exact core of a curved body, which counts with its inside; null for triangles.
  ///
  /// The least distance of curved bodies is not searched for.
  const RoundSet* round = nullptr;
};

/// The meaning of a promised distance.
enum class Promise {
  kept,      ///< The distance less 2^-20 of it, and less twice the rounding; above 0 in any case.
  exceeded,  ///< Strictly farther apart than the distance, all roundings included.
};

struct CoverOptions {
  Promise promise = Promise::kept;
  double promised = 0.0;  ///< [m]  The claimed distance.
  /// [m]  A distance that is exceeded in addition to a promise that is kept.
  std::optional<double> exceeded = {};
  /// [m]  A distance to which some pair of the run is known to come.
  ///
  /// A pair that stays farther is of no interest beyond the promise.
  double known = std::numeric_limits<double>::infinity();
  bool finds_least = true;  ///< Whether the least distance is searched for, beyond the promise.
  /// Begin of the time of the proof, as far as there are pieces; equal to `to` for one instant.
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  /// [-]  How often the bound of tracking errors is added to the promise.
  ///
  /// The distance is then that of the nominal motions. At 0 the errors count as errors, and the
  /// distance is that of all motions within them.
  double tracked = 0.0;
  std::size_t work = 0;  ///< Number of tests of two boxes or two triangles after which it gives up.
  std::stop_token stop = {};  ///< Ends it as spent work does.
};

/// The outcome of a proof of a pair.
///
/// With Promise::exceeded, `closer` is proven: at `time` the two are no farther apart than
/// promised.
enum class CoverOutcome { proven, closer, not_proven };

struct CoverResult {
  CoverOutcome outcome = CoverOutcome::not_proven;
  /// [m]  Proven: the bodies, jumps included, never come closer.
  ///
  /// It may be greater where they are farther than `known` before or `seen` now.
  double least = 0.0;
  double seen = std::numeric_limits<double>::infinity();  ///< [m]  The bodies come at least as
                                                          ///< close.
  double seen_time = 0.0;                                 ///< [s]  The time of that.
  double time = 0.0;   ///< [s]  Time at which they are closer than promised, or nothing could be
                       ///< proven.
  double half = 0.0;   ///< [s]  Nothing is proven for so long before and after that.
  bool ended = false;  ///< Whether work or the stop token ended it.
};

/// Proves that the bodies stay apart as promised. Times are those of the pieces.
[[nodiscard]] CoverResult cover_pair(const CoverBody& A, const CoverBody& B,
                                     const CoverOptions& options);

}  // namespace firstcontact::detail
