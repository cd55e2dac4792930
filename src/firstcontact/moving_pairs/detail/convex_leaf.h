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
  /// Places two leaves.
  ///
  /// @param pair   at least one of its bodies is a convex set
  /// @param a, b   triangles in the hierarchies' order, for a body that is queried by its triangles
  ConvexLeaf(const MovingPair& pair, const RelativeState& state, std::uint32_t a, std::uint32_t b);
  ConvexLeaf(const ConvexLeaf&) = delete;
  ConvexLeaf& operator=(const ConvexLeaf&) = delete;

  [[nodiscard]] const PlacedConvex& A() const { return *A_; }
  [[nodiscard]] const PlacedConvex& B() const { return *B_; }

  /// Finds the closest points of the leaves, as closest_points().
  [[nodiscard]] ConvexClosest closest(const ConvexWanted& wanted, ConvexGuess& guess) const {
    return closest_points(*A_, *B_, wanted, guess);
  }

 private:
  /// Makes the core of a triangle from its first corner, in the axes of its body. So a guess holds
  /// at other times.
  const ConvexCore& triangle_core(const Hierarchy& hierarchy, std::uint32_t triangle);

  // The corners of the triangle. At most one body is queried by triangles here.
  std::array<Eigen::Vector3d, 3> corners_;
  ConvexCore triangle_;
  std::optional<PlacedConvex> A_;
  std::optional<PlacedConvex> B_;
};

/// A first guess of the direction: from the centre of A towards that of B.
[[nodiscard]] ConvexGuess guess_of(const ConvexLeaf& leaf);

/// Finds the closest points of two leaves, with their features. A set has its face as the feature.
/// Pairs that are proven farther apart than `within` get any points that are so.
///
/// The points are those of closest_points(), turned about their middle to lie along the direction
/// that separates best. This direction is accurate where the points almost coincide.
[[nodiscard]] ClosestFeatures closest_features(
    const MovingPair& pair, const RelativeState& state, std::uint32_t a, std::uint32_t b,
    double within = std::numeric_limits<double>::infinity());

}  // namespace firstcontact::detail
