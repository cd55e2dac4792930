/// @file
/// Two shapes over one piece of their motions: positions of boxes and triangles, error terms.

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

namespace firstcontact::detail {

/// A box of a hierarchy: slot `slot` of node `node`.
struct BoxId {
  std::uint32_t node = 0;
  std::uint32_t slot = 0;
};

/// A box at one instant, in the frame of the RelativeState.
struct PlacedBox {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;    ///< The axes of the box, one per row.
  Eigen::Vector3d extent;  ///< [m]
  double radius = 0.0;     ///< [m]
  bool is_triangle = false;
  /// [m]  Corners of the triangle in the box, relative to the centre; one per row.
  Eigen::Matrix3d corners;
  /// [m]  Greatest distance of a point of the box from the body's pivot, to the end of the step.
  double reach = 0.0;
  Eigen::Vector3d velocity;  ///< [m per step]  Velocity of the centre, relative to A's pivot.
  bool deforms = false;
  Eigen::Vector3d growth;            ///< [m per step]  Growth of the extents.
  Eigen::Matrix3d corner_growth;     ///< [m per step]  Rates of the corners; one per row.
  const ConvexCore* core = nullptr;  ///< The core of a convex set, which replaces the box.
  Eigen::Matrix3d R_core;            ///< [-]  Axes of the core's frame.
  Eigen::Vector3d p_core;            ///< [m]  Origin of the core's frame, from the centre.
};

/// Rounds a value >= 0 up, for the fields of a BoxFrame. The answer is above 0. At the very end of
/// a step the horizon is 0, and a pair that is not proven apart for any time must not be dropped.
inline float round_up(double value) {
  return static_cast<float>(value * (1.0 + 0x1p-22)) + std::numeric_limits<float>::min();
}

/// Rounds a value down.
inline float below(double value) { return static_cast<float>(value - std::abs(value) * 0x1p-22); }

/// Rounds a value down, but not below 0.
inline float round_down(double value) { return std::max(0.0f, below(value)); }

/// Whether queries of a pair take a shape as the convex set that it is, not by its triangles.
[[nodiscard]] bool is_asked_as_convex(const Shape& shape, const Shape& partner);

/// [m]  Sums the enclosure errors of both shapes, where their triangles replace curved bodies.
[[nodiscard]] double enclosure_error(const Shape& A, const Shape& B);

/// Two bodies over one piece of their motions.
class MovingPair {
 public:
  /// Takes the triangles of both bodies.
  ///
  /// @param motion  has entered a piece
  MovingPair(const Hierarchy& A, const Hierarchy& B, const PairMotion& motion);

  /// Takes the convex set of a curved shape in place of its triangles. Then it takes the set of the
  /// partner as well, where the partner has one of few points. A shape that deforms is taken by its
  /// triangles, and so is its partner.
  MovingPair(const Shape& A, const Shape& B, const PairMotion& motion);

  [[nodiscard]] const Hierarchy& A() const { return A_; }
  [[nodiscard]] const Hierarchy& B() const { return B_; }
  [[nodiscard]] const PairMotion& motion() const { return motion_; }

  /// [m]  Bounds the error of any gap computed from positions at this state.
  ///
  /// Derivation, u = 2^-53: a rotated vertex is within 31 u of its length (22 u for the matrix, 9 u
  /// for the product). The addition of p_AB and a dot product with a unit vector add 8 u of R_A +
  /// R_B + |p_AB|. Vertices were rounded to u / 2 when they were centred. For convex sets it is
  /// convex_gap_error().
  [[nodiscard]] double gap_error(const RelativeState& state) const;

  [[nodiscard]] PlacedBox place_A(const RelativeState& state, BoxId box) const;
  [[nodiscard]] PlacedBox place_B(const RelativeState& state, BoxId box) const;
  [[nodiscard]] TrianglePair place(const RelativeState& state, std::uint32_t triangle_A,
                                   std::uint32_t triangle_B) const;

  /// The velocities of the corners in the frames of their bodies, in world axes.
  [[nodiscard]] TrianglePair rates(const RelativeState& state, std::uint32_t triangle_A,
                                   std::uint32_t triangle_B) const;

  /// [-]  Computes a time for which two boxes are provably farther apart than the threshold.
  ///
  /// The directions are those of the centre line and of each box's axes. A triangle's box counts as
  /// its triangle only. The first direction that lasts for `enough` ends the search.
  ///
  /// The boxes of a body that deforms grow. Derivation: if the body did not turn, all vertices
  /// would stay in the interpolated box, whose reach n . c + sum |n . a_k| h_k along n is linear in
  /// time. A turn adds the velocities at the present places of the vertices, and the accelerations
  /// of advance_deforming().
  [[nodiscard]] double time_apart(const RelativeState& state, const PlacedBox& a,
                                  const PlacedBox& b, double threshold, double error,
                                  double enough) const;

  /// [m]  Bounds the distance of two boxes at this instant from below, by the same directions;
  /// negative where none separates.
  [[nodiscard]] static double gap(const PlacedBox& a, const PlacedBox& b);

  /// [m]  Bounds the same distance by one direction.
  ///
  /// @param n  [-]  unit, to the last bits
  [[nodiscard]] static double gap_along(const Eigen::Vector3d& n, const PlacedBox& a,
                                        const PlacedBox& b);

  /// The convex core of a body, from its point C; null where its triangles are taken.
  [[nodiscard]] const ConvexCore* convex_A() const { return convex_A_ ? &*convex_A_ : nullptr; }
  [[nodiscard]] const ConvexCore* convex_B() const { return convex_B_ ? &*convex_B_ : nullptr; }
  [[nodiscard]] bool is_convex() const { return convex_A_ || convex_B_; }  ///< One body, or both.

  [[nodiscard]] bool deforms() const { return A_.deforms() || B_.deforms(); }

  /// Bounds the boxes of a pair of nodes by bound_boxes(), or its variant for bodies that deform.
  void bound(const BoxFrame& frame, std::uint32_t node_a, std::uint32_t node_b,
             BoxBounds& bounds) const;
  /// Bounds the boxes of two pairs of nodes in less than twice the time.
  void bound(const BoxFrame& frame, std::uint32_t node_a, std::uint32_t node_b, BoxBounds& bounds,
             std::uint32_t other_a, std::uint32_t other_b, BoxBounds& other_bounds) const;

  /// The part of the kernel's input that is the same at all times.
  [[nodiscard]] BoxFrame box_frame() const;
  /// Sets the rest of the kernel's input for one instant, but for the horizon.
  ///
  /// @param threshold  [m]  the error of the gap included
  void place(const RelativeState& state, double threshold, BoxFrame& frame) const;

  /// [m]  The unit of the kernel's lengths.
  [[nodiscard]] double unit() const { return std::max(A_.unit, B_.unit); }

  /// [m per step]  Bound of the rate at which any distance can change over the piece.
  [[nodiscard]] double speed_bound() const { return speed_bound_; }

 private:
  void place_bend(const RelativeState& state, BoxFrame& frame) const;

  const Hierarchy& A_;
  const Hierarchy& B_;
  const PairMotion& motion_;
  double speed_bound_;
  std::optional<ConvexCore> convex_A_;
  std::optional<ConvexCore> convex_B_;
};

}  // namespace firstcontact::detail
