/// @file
/// How a step is divided where a scripted body does not move straight.

#pragma once

#include <vector>

#include <firstcontact/motion/motion.h>

namespace firstcontact::detail {

/// A scripted body that a step follows.
struct ScriptedMotion {
  Motion motion;
  double reach = 0.0;  ///< [m]  No point of the body is farther from its origin.
};

/// [m]  How far at most any point of the body is from where a straight piece would have it: the
/// origin on a line, the turn at a constant rate (rotation_between).
///
/// Two bounds hold between two breaks of the motion. The vector between the origins has a second
/// derivative of at most rate^2 lever. The angle between the orientations changes no faster than by
/// the difference of the two rates. Rounding is not charged: `verify` proves the run by itself.
///
/// @param from, to  in [0, 1], from < to
[[nodiscard]] double bend_bound(const ScriptedMotion& script, double from, double to);

/// The ends of the parts of a step, of which each is straight to the tolerance for all scripts: the
/// last one is `to`. Parts end at breaks of a motion where there are any, else in the middle.
///
/// @param tolerance  [m]  > 0
/// @returns  nothing where more than 10,000 parts would be needed
[[nodiscard]] std::vector<double> straight_parts(const std::vector<ScriptedMotion>& scripts,
                                                 double from, double to, double tolerance);

}  // namespace firstcontact::detail
