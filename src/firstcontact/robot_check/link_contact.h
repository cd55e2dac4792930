/// @file
/// First contact of two bodies that move by joints.

#pragma once

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// A shape S and its motion X_FS(t) in a frame that both bodies of a question share.
///
/// The frame is the world, or the last common ancestor of two links.
struct MovingLink {
  const Shape& shape;
  const LinkMotion& X_FS;
};

/// Finds the first contact of A and B during the step; contacts are in the frame F.
///
/// The promises are those of first_contact() for two moving shapes. The answer for B and A is the
/// same, up to the swap.
///
/// Method: the search is that of docs/algorithm.md, over windows of time in which no point's path
/// bends by more than about half of itself (LinkPairMotion).
///
/// A shape may deform if its motion has constant rates (LinkPath::constant_rates): a body's shape,
/// not a link's.
///
/// @throws std::invalid_argument if an option is outside its range, or the shape of a link deforms
FIRSTCONTACT_API void first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                                    const FirstContactOptions& options, FirstContactResult& result);
[[nodiscard]] FIRSTCONTACT_API FirstContactResult
first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
              const FirstContactOptions& options = {});

/// Finds the first contact in a window of the step; before it the shapes are proven free.
///
/// The motions may have only the pieces that the window lies in. When free, `t` is its end.
FIRSTCONTACT_API void first_contact(const MovingLink& A, const MovingLink& B,
                                    const TimeWindow& window, Workspace& workspace,
                                    const FirstContactOptions& options, FirstContactResult& result);

/// Finds the distance at a time as distance() of two moving shapes does, in the frame F.
[[nodiscard]] FIRSTCONTACT_API DistanceResult distance(const MovingLink& A, const MovingLink& B,
                                                       double t, Workspace& workspace);

/// Finds the closest approach as closest_approach() of two moving shapes does, in the frame F.
[[nodiscard]] FIRSTCONTACT_API ClosestApproachResult
closest_approach(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                 const ClosestApproachOptions& options = {});

}  // namespace firstcontact
