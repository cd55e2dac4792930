/// @file
/// Bounds of 16 pairs of boxes at once: each box of one node with each box of another.

#pragma once

#include <cstdint>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {

/// Two bodies at one instant, as the kernel reads them; plain numbers, so that it can be compiled
/// for several instruction sets. Lengths in units of the larger hierarchy, a power of two; world
/// axes, origin at A's centre; index 0 is A, 1 is B.
struct BoxFrame {
  double rotation[2][9];  ///< Row-major.
  float rounded[2][9];    ///< The same, rounded.
  double origin[2][3];    ///< Centres of the hierarchies.
  double pivot[2][3];
  double ratio[2];       ///< Unit of the hierarchy.
  float spin[2][3];      ///< [rad per step]
  float rate[2];         ///< Its length.
  float velocity[2][3];  ///< Of the pivots: zero for A, relative to A's for B.
  float speed;           ///< At least the length of the latter.
  float drift;           ///< At least those of RelativeState.
  float bend;
  float bend_by_distance[2];  ///< [per step^2]  Of each body, for points that far from its pivot.
  float threshold;            ///< Closer is contact; the error of positions in double is included.
  float horizon;              ///< Pairs apart for this long are done with.
  float far;                  ///< [-]  A gap is large beyond this part of the boxes' radii.
  float larger;               ///< [-]  A box larger than another by this factor is opened alone.
  double t;                   ///< Where boxes are interpolated, of bodies that deform.
  float deformation[2];       ///< At least the speed of their vertices, as their bodies see them.
};

/// The bounds of lane 4 i + j, for box i of A's node and box j of B's.
struct BoxBounds {
  /// [-]  Provably farther apart than the threshold for this long, to the horizon at most.
  alignas(64) float time[16];
  alignas(64) float gap[16];  ///< [unit]  Lower bound of the distance at this instant; may be < 0.
  std::uint16_t live;         ///< Time is below the horizon.
  std::uint16_t far;          ///< The gap is large for the size of the boxes.
  std::uint16_t larger_a;     ///< A's box is so much larger that it alone should be opened.
  std::uint16_t larger_b;
  std::uint16_t unsure;  ///< Double precision may find a direction that separates for longer.
};

/// The bounds of docs/algorithm.md, section 2, along five directions: the line of centres and the
/// two thinner axes of each box. In single precision: gaps are reduced by 64 and speeds raised by
/// 32 units in the last place of everything that enters them (derived in the source). Lanes of
/// slots that are not used hold anything.
void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds);

/// The same of two pairs of nodes in less than twice the time.
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

/// The instruction sets that bound_boxes was compiled for and that this processor has, as bits of
/// Highway's HWY_TARGETS; for tests.
std::int64_t box_bounds_targets();

}  // namespace firstcontact::detail
