/// @file
/// The verifier's proof for one pair of bodies and one step.
///
/// It covers the whole step by windows of time, in each of which every two triangles are separated
/// along some direction.

#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <firstcontact/verification/detail/box_tree.h>
#include <firstcontact/verification/detail/piece_motion.h>

namespace firstcontact::detail {

struct CoverBody {
  const BoxTree& tree;
  const std::vector<PieceMotion>& pieces;  ///< One after another, over the whole step.
  double thickness = 0.0;                  ///< [m]  Of the shape around its triangles.
  double jump = 0.0;                       ///< [m]  Between the end of a piece and the next begin.
};

struct CoverOptions {
  double promised = 0.0;  ///< [m]  The distance that was claimed.
  /// [m]  Some pair of the run is known to come this close: what stays farther is of no interest
  /// beyond the promise.
  double known = std::numeric_limits<double>::infinity();
  std::size_t work = 0;  ///< Tests of two boxes or two triangles before it gives up.
};

enum class CoverOutcome { proven, closer, not_proven };

struct CoverResult {
  CoverOutcome outcome = CoverOutcome::not_proven;
  /// [m]  Proven: the bodies, jumps included, never come closer; unless they are farther than
  /// `known` then or `seen` now.
  double least = 0.0;
  double seen = std::numeric_limits<double>::infinity();  ///< [m]  They come at least as close,
  double seen_time = 0.0;                                 ///< [s]  then.
  double time = 0.0;  ///< [s]  Where it is closer than promised, or could not be proven.
};

/// Proves that the bodies stay apart, by the promise less 2^-20 of it and less twice the rounding.
///
/// They stay apart at any rate. Times are of the pieces.
[[nodiscard]] CoverResult cover_pair(const CoverBody& A, const CoverBody& B,
                                     const CoverOptions& options);

}  // namespace firstcontact::detail
