/// @file
/// The verifier's proof for one pair of bodies and one step.
///
/// It covers the whole step by windows of time, in each of which every two triangles are separated
/// along some direction.

#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>

#include <firstcontact/verification/detail/box_tree.h>
#include <firstcontact/verification/detail/covered_motion.h>

namespace firstcontact::detail {

struct CoverBody {
  const BoxTree& tree;
  /// One after another, over all that is to be proven.
  std::span<const CoveredMotion* const> pieces;
  double thickness = 0.0;  ///< [m]  Of the shape around its triangles.
  double jump = 0.0;       ///< [m]  Between the end of a piece and the next begin.
};

/// The sense in which a distance is promised.
enum class Promise {
  kept,      ///< Less 2^-20 of it, and less twice the rounding; above 0 at any rate.
  exceeded,  ///< Farther apart than it, strictly, all roundings included.
};

struct CoverOptions {
  Promise promise = Promise::kept;
  double promised = 0.0;  ///< [m]  The distance that was claimed.
  /// [m]  Beside a promise that is kept: this one is exceeded.
  std::optional<double> exceeded = {};
  /// [m]  Some pair of the run is known to come this close: what stays farther is of no interest
  /// beyond the promise.
  double known = std::numeric_limits<double>::infinity();
  bool finds_least = true;  ///< Else nothing is searched for beyond the promise.
  /// What is to be proven, as far as there are pieces. One instant where both are the same.
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  /// Whether a distance of nominal motions is asked: then what tracking adds belongs to the
  /// promise, else to what may be wrong.
  bool nominal = false;
  std::size_t work = 0;       ///< Tests of two boxes or two triangles before it gives up.
  std::stop_token stop = {};  ///< Ends it as work does.
};

/// With Promise::exceeded, `closer` is proven: at `time` the two are no farther apart than
/// promised.
enum class CoverOutcome { proven, closer, not_proven };

struct CoverResult {
  CoverOutcome outcome = CoverOutcome::not_proven;
  /// [m]  Proven: the bodies, jumps included, never come closer; unless they are farther than
  /// `known` then or `seen` now.
  double least = 0.0;
  double seen = std::numeric_limits<double>::infinity();  ///< [m]  They come at least as close,
  double seen_time = 0.0;                                 ///< [s]  then.
  double time = 0.0;   ///< [s]  Where it is closer than promised, or could not be proven.
  double half = 0.0;   ///< [s]  Not proven so much before and after that.
  bool ended = false;  ///< By work or the stop token.
};

/// Proves that the bodies stay apart as promised. Times are of the pieces.
[[nodiscard]] CoverResult cover_pair(const CoverBody& A, const CoverBody& B,
                                     const CoverOptions& options);

}  // namespace firstcontact::detail
