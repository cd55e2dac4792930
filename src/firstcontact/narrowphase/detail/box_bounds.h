/// @file
/// Bounds of 16 pairs of boxes at once: each box of one node with each box of another.

#pragma once

#include <cstdint>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {

/// Two bodies at one instant, as the kernel reads them.
///
/// These are plain numbers, so that the kernel can be compiled for several instruction sets.
/// Lengths are in units of the larger hierarchy, a power of two. Axes are the world's, and the
/// origin is at A's centre. Index 0 is A, 1 is B.
struct BoxFrame {
  double rotation[2][9];  ///< Row-major.
  float rounded[2][9];    ///< The rotation in single precision.
  double origin[2][3];    ///< Centres of the hierarchies.
  double pivot[2][3];
  double ratio[2];       ///< Unit of the hierarchy over the unit of lengths.
  float spin[2][3];      ///< [rad per step]
  float rate[2];         ///< [rad per step]  Length of `spin`.
  float velocity[2][3];  ///< Velocity of the pivot: zero for A, relative to A's for B.
  float speed;           ///< At least the length of B's velocity.
  float drift;           ///< At least the drift of RelativeState.
  float bend;
  float bend_by_distance[2];  ///< [per step^2]  For each body, per distance of a point from its
                              ///< pivot.
  float threshold;            ///< Closer is contact; the error of positions in double is included.
  float horizon;              ///< Pairs apart for this long are done with.
  float far;                  ///< [-]  A gap is large beyond this part of the boxes' radii.
  float larger;               ///< [-]  A box larger than another by this factor is opened alone.
  double t;                   ///< Time at which boxes of deforming bodies are interpolated.
  float deformation[2];       ///< At least the speed of the vertices, as seen from their bodies.
};

/// The bounds of 16 pairs; lane 4 i + j is box i of A's node and box j of B's.
struct BoxBounds {
  /// [-]  The boxes are provably farther apart than the threshold for this long; at most the
  /// horizon.
  alignas(64) float time[16];
  alignas(64) float gap[16];  ///< [unit]  Lower bound of the distance at this instant; may be < 0.
  std::uint16_t live;         ///< Bits of lanes whose time is below the horizon.
  std::uint16_t far;          ///< Bits of lanes whose gap is large for the size of the boxes.
  std::uint16_t larger_a;  ///< Bits of lanes where A's box is so much larger that it alone should
                           ///< be opened.
  std::uint16_t larger_b;  ///< Likewise for B's box.
  std::uint16_t unsure;    ///< Bits of lanes where double precision may find a direction that
                           ///< separates for longer.
};

/// Bounds 16 pairs of boxes along five directions, as in docs/algorithm.md, section 2.
///
/// The directions are the line of centres and the two thinner axes of each box. Numbers are in
/// single precision. Gaps are reduced by 64, and speeds raised by 32, units in the last place of
/// all that enters them (derived in the source). Lanes of unused slots hold any value.
void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds);

/// Bounds two pairs of nodes at once, in less than twice the time of one.
void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds, const HierarchyNode& other_a, const HierarchyNode& other_b,
                 BoxBounds& other_bounds);

/// Bounds the boxes of bodies that deform, with each node as it is at t = 0 and at t = 1.
///
/// A body that does not deform has the same node twice.
///
/// Boxes grow and move as in docs/algorithm.md, section 10.
void bound_deforming_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                           const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds);

/// The instruction sets of this processor for which bound_boxes was compiled, as bits of Highway's
/// HWY_TARGETS; for tests.
std::int64_t box_bounds_targets();

}  // namespace firstcontact::detail
