/// @file
/// Pairs of triangles that stay apart because their surfaces slide along a screw, as a nut on its
/// bolt.

#pragma once

#include <cstddef>
#include <optional>

#include <firstcontact/geometry/screw_sliding_bounds.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// The proof for two bodies with screw surfaces: the carrier does not turn, the other one moves
/// nearly along its screw.
///
/// Derivation: S(a) is the screw turned by a. Seen from the carrier, x(t) is the path of a point of
/// the other body. Let y(t) = S(-a(t)) x(t), with a(t) linear in time. S keeps distances, so the
/// distance of x from a point c of the carrier is that of y from S(-a) c. This point has the r and
/// h of c, and an angle less by a, while y stays nearly in place. Now f(r, h) = alpha r + beta h
/// changes by no more than L per length. Where f differs by more than L d for all points of two
/// surfaces, these stay farther apart than d, for as long as a is within its range. The same holds
/// where their angles differ. Angles are equal up to whole turns: one more turn takes 2 pi pitch
/// off h.
///
/// y(t) is near its chord. w_s is the rate of the screw, w that of the body, and s that of the
/// body's pivot q, all seen from the carrier with z the axis. w_d = w - w_s, and p is the point's
/// place from the pivot. Relative to the screw the point moves by u = s - pitch w_s
/// z - w_s x q + w_d x p, and
///   |y''| <= w_s |s across z| + |w_d| w |p| + w_s |u|.
class ScrewSlidingCover {
 public:
  /// Makes the proof of two such bodies; none for any others.
  static std::optional<ScrewSlidingCover> of(const MovingPair& pair, const Shape& A, const Shape& B,
                                             double t);

  /// Finds all pairs of triangles that are not proven farther apart than the threshold throughout
  /// [t, t_end] of the piece.
  ///
  /// They are in WorkspaceData::left_by_screw_sliding. It returns false, with some missing, where
  /// they are more than `most`, or the bodies move otherwise.
  bool find(double t_end, double threshold, std::size_t most, WorkspaceData& workspace) const;

 private:
  ScrewSlidingCover(const MovingPair& pair, const ScrewSlidingSurface& carrier,
                    const ScrewSlidingSurface& other, bool carrier_is_A, double t)
      : pair_(pair), carrier_(carrier), other_(other), carrier_is_A_(carrier_is_A), t_(t) {}

  struct Window;
  [[nodiscard]] std::optional<Window> window(double t_end, double threshold) const;
  void walk(const ScrewSlidingLimits& limits, std::size_t most, WorkspaceData& workspace) const;

  const MovingPair& pair_;
  const ScrewSlidingSurface& carrier_;
  const ScrewSlidingSurface& other_;
  bool carrier_is_A_;
  double t_;
};

}  // namespace firstcontact::detail
