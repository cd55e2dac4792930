/// @file
/// First contact of two bodies that move by joints.

#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include <firstcontact/articulated/robot_motion.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {

/// A shape S and its motion X_FS(t) in a frame that both bodies of a question share: the world, or
/// the last common ancestor of two links.
struct MovingLink {
  const Shape& shape;
  const LinkMotion& X_FS;
};

struct LinkContactOptions {
  double margin = 0.0;      ///< [m]  Closer than this counts as contact; >= 0.
  double tolerance = 1e-6;  ///< [m]  A reported contact is no farther than margin + tolerance; > 0.
  /// Node pairs and steps of triangle pairs; spending them gives `undecided`.
  std::uint64_t steps = std::numeric_limits<std::uint64_t>::max();
};

struct LinkContactResult {
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;  ///< `work` or `precision`.
  double t = 0.0;                ///< [-]  [0, t) is proven free of contact; 1 when free.
  double tolerance_used = 0.0;   ///< [m]  In place of the asked one; larger only if f64 needs it.
  double enclosure_error = 0.0;  ///< [m]  Of both shapes: adds to the tolerance of a contact.
  double distance = 0.0;         ///< [m]  Of the triangles in contact; 0 for one inside a solid.
  std::array<std::uint32_t, 2> triangles = {};  ///< In contact, by their indices in the shapes.
  Eigen::Vector3d p_FA =
      Eigen::Vector3d::Zero();  ///< [m]  Their closest points, before thickening.
  Eigen::Vector3d p_FB = Eigen::Vector3d::Zero();
  std::uint64_t steps = 0;
};

/// Finds the first contact of A and B during the step, with the promises of `first_contact` of two
/// moving shapes; contacts are in the frame F.
///
/// The search is that of docs/algorithm.md, over windows of time in which no point's path bends by
/// more than about half of itself (LinkPairMotion). The same for A and B swapped, up to the swap.
///
/// @throws std::invalid_argument if an option is outside its range, or a shape deforms
FIRSTCONTACT_API void first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                                    const FirstContactOptions& options, FirstContactResult& result);
[[nodiscard]] FIRSTCONTACT_API FirstContactResult
first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
              const FirstContactOptions& options = {});

/// The same in a part of the step; before it the shapes are proven free. The motions may have only
/// the pieces that the part lies in. When free, `t` is its end.
FIRSTCONTACT_API void first_contact(const MovingLink& A, const MovingLink& B,
                                    const TimeWindow& window, Workspace& workspace,
                                    const FirstContactOptions& options, FirstContactResult& result);

/// As distance() of two moving shapes, in the frame F.
[[nodiscard]] FIRSTCONTACT_API DistanceResult distance(const MovingLink& A, const MovingLink& B,
                                                       double t, Workspace& workspace);

/// As closest_approach() of two moving shapes, in the frame F.
[[nodiscard]] FIRSTCONTACT_API ClosestApproachResult
closest_approach(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                 const ClosestApproachOptions& options = {});

/// The same with a result of its own.
[[nodiscard]] FIRSTCONTACT_API LinkContactResult
first_contact(const MovingLink& A, const MovingLink& B, const LinkContactOptions& options = {});

}  // namespace firstcontact
