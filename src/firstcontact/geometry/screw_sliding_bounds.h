/// @file
/// Bounds of a surface in the coordinates of its screw, at all times of a motion along it.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/screw_sliding.h>
#include <firstcontact/geometry/screw_sliding_order.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Bounds of four parts of a surface, all as upper bounds.
///
/// For each part they bound two quantities from both sides: f = alpha r + beta h [m] along the
/// directions (alpha, beta) of the ScrewSliding, and the angle [rad]. The order is:
///   -least f of each direction, -least angle, greatest f of each direction, greatest angle.
/// For a mirrored body, the halves are exchanged.
struct alignas(64) ScrewSlidingNode {
  static constexpr std::size_t kParts = 4;
  static constexpr std::size_t kNumbers = 2 * (ScrewSliding::kDirections + 1);
  float most[kParts][kNumbers];
};

/// The bounds of a vertex, in the same order.
struct alignas(64) ScrewSlidingVertex {
  float most[ScrewSlidingNode::kNumbers];
};

/// A rigid body in the axes of the screw S of a `ScrewSliding`, less the motion along the screw.
///
/// Between the two poses its points stay within `stray` of lines. They may move along the lines at
/// any rates.
struct ScrewSlidingPath {
  std::array<Eigen::Matrix3d, 2> R_SB;
  std::array<Eigen::Vector3d, 2> p_SB;  ///< [m]  The place of Hierarchy::centre.
  double stray = 0.0;                   ///< [m]  Bound of a point's distance from its line.
};

/// Bounds of the triangles in an order of their own, as a tree with four children to a node.
///
/// Four triangles belong to a node, four such nodes to the next one, and so on. Part k of node n of
/// a level is node 4 n + k of the level below it, or triangle 4 n + k. There are always as many
/// levels as the largest mesh needs.
struct ScrewSlidingBounds {
  static constexpr std::size_t kLevels = 14;
  std::array<std::vector<ScrewSlidingNode>, kLevels> levels = {};
  double error = 0.0;  ///< [m]  Error of sums of two bounds; the bounds do not contain it.

  /// The radius, angle and height of vertices, at both poses.
  std::array<std::vector<float>, 2> radius = {};
  std::array<std::vector<float>, 2> angle = {};
  std::array<std::vector<float>, 2> height = {};
  std::vector<ScrewSlidingVertex> of_vertices = {};

  /// Frees the numbers of vertices, for callers that need only the nodes.
  void release_vertices() {
    radius = {};
    angle = {};
    height = {};
    of_vertices = {};
  }
};

/// Bounds a shape that does not deform.
///
/// Derivation: at one time a triangle is the convex hull of its corners. All of it stays within
/// `stray` of the convex hull of the corners at both poses. For x = sum l_i y_i in that hull,
/// - z is linear, and r convex: r(x) <= sum l_i r_i;
/// - with g the direction of the middle of the angles, which span 2 D,
///   r(x) >= g . x >= sum l_i r_i cos D, and 1 - cos D <= D^2 / 2;
/// - along a line the angle's second derivative is -2 e_r e_a / r^2, at most 1 / r^2 in size, so
///   |angle(x) - sum l_i angle_i| <= sum l_i |y_i - x|^2 / (2 r^2) <= R^2 / (2 r^2), lengths taken
///   across the axis and R that of any circle around the y_i.
///
/// f changes by at most L = sqrt(alpha^2 + beta^2 (1 + pitch^2 / r^2)) times `stray`. A triangle
/// that comes nearer to the axis than twice ScrewSliding::least_radius, or lies around it, is only
/// bounded in r and z. Its other numbers are huge.
///
/// Single precision: angles are within 2^-20, places within 2^-23 of size. `error` and the terms
/// added to each bound are larger than that.
/// @param order  the triangles in sequence, so that neighbours are near in r, h and angle
/// @param path   the two motions; their poses coincide at one time
FIRSTCONTACT_API void bound_screw_sliding(const ScrewSliding& screw_sliding,
                                          const Hierarchy& hierarchy,
                                          std::span<const std::uint32_t> order,
                                          const ScrewSlidingPath& path, bool mirrored,
                                          ScrewSlidingBounds& bounds);

/// A surface that slides in itself along a screw, at rest in the axes of that screw.
struct ScrewSlidingSurface {
  ScrewSliding screw_sliding;
  std::vector<std::uint32_t> order;  ///< Order of the triangles, along the screw thread.
  ScrewSlidingBounds bounds;
};

/// The limits of two near parts: no sum of their numbers is below these.
struct ScrewSlidingLimits {
  alignas(64) std::array<float, ScrewSlidingNode::kNumbers> least;
  /// The amounts that one more turn around the axis adds.
  alignas(64)
      std::array<float, ScrewSlidingNode::kNumbers> turn;  ///< Once more around the axis adds it.
};

/// Finds the lanes 4 i + j of the parts i of one body and j of a mirrored one that are near each
/// other.
[[nodiscard]] FIRSTCONTACT_API unsigned near_by_screw_sliding(const ScrewSlidingNode& a,
                                                              const ScrewSlidingNode& mirrored,
                                                              const ScrewSlidingLimits& limits);

/// [-]  Bounds the slope of f along the direction, where bounds hold.
[[nodiscard]] FIRSTCONTACT_API double slope_of(const ScrewSliding& screw_sliding,
                                               std::size_t direction);

}  // namespace firstcontact
