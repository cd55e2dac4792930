/// @file
/// A pair of leaves of which at least one is a convex set, at one instant.

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/convex_closest.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact::detail {

/// Two leaves of a pair, placed in the frame of a state; a triangle is a convex set as well.
class ConvexLeaf {
 public:
  /// @param pair   of which one is a convex set, or both are
  /// @param a, b   triangles in the hierarchies' order, where a body is asked by its triangles
  ConvexLeaf(const MovingPair& pair, const RelativeState& state, std::uint32_t a, std::uint32_t b);
  ConvexLeaf(const ConvexLeaf&) = delete;
  ConvexLeaf& operator=(const ConvexLeaf&) = delete;

  [[nodiscard]] const PlacedConvex& A() const { return *A_; }
  [[nodiscard]] const PlacedConvex& B() const { return *B_; }

  /// As closest_points().
  [[nodiscard]] ConvexClosest closest(const ConvexWanted& wanted, ConvexGuess& guess) const {
    return closest_points(*A_, *B_, wanted, guess);
  }

 private:
  /// Seen from its first corner, in the axes of its body: so a guess holds at other times.
  const ConvexCore& triangle_core(const Hierarchy& hierarchy, std::uint32_t triangle);

  std::array<Eigen::Vector3d, 3> corners_;  // Of the triangle; two of them are never asked here.
  ConvexCore triangle_;
  std::optional<PlacedConvex> A_;
  std::optional<PlacedConvex> B_;
};

/// A first guess: from the centre of the one towards that of the other.
[[nodiscard]] ConvexGuess guess_of(const ConvexLeaf& leaf);

/// The closest points of two leaves, with the features of the triangle if one is; the set's is its
/// face. Pairs that are proven farther apart than `within` have any points that are.
///
/// The points are those of closest_points(), turned about their middle to lie along the direction
/// that separates best: it is accurate where they nearly coincide.
[[nodiscard]] ClosestFeatures closest_features(
    const MovingPair& pair, const RelativeState& state, std::uint32_t a, std::uint32_t b,
    double within = std::numeric_limits<double>::infinity());

}  // namespace firstcontact::detail
