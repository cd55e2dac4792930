/// @file
/// Queries of two shapes, whatever kind of motion they follow.

#pragma once

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// Two shapes and their relative motion.
///
/// The motion's points C are the centres of the shapes' hierarchies. The motion of a shape that
/// deforms has constant rates.
struct ShapePair {
  const Shape& A;
  const Shape& B;
  PairMotion& motion;
};

/// Finds the first contact as for two moving shapes, in the frame of the motion.
///
/// Answers for A and B swapped may differ in the last bits: the caller puts them in an order of his
/// own.
///
/// @param window  before it the shapes are proven free; when free, `t` is its end
FIRSTCONTACT_API void first_contact(const ShapePair& pair, const TimeWindow& window,
                                    Workspace& workspace, const FirstContactOptions& options,
                                    FirstContactResult& result);

/// Finds the distance as for two moving shapes, in the frame of the motion.
[[nodiscard]] FIRSTCONTACT_API DistanceResult distance(const ShapePair& pair, double t,
                                                       Workspace& workspace);

/// Finds the closest approach as for two moving shapes, in the frame of the motion.
[[nodiscard]] FIRSTCONTACT_API ClosestApproachResult closest_approach(
    const ShapePair& pair, Workspace& workspace, const ClosestApproachOptions& options = {});

}  // namespace firstcontact
