/// @file
/// How a step is divided where a body that moves by itself does not move straight.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/motion/motion.h>

namespace firstcontact::detail {

/// A body that moves by itself, and that a step follows.
struct ScriptedMotion {
  Motion motion;
  double reach = 0.0;  ///< [m]  No point of the body is farther from its origin.
};

/// The rotation vector over a part of a motion: of one piece with all its turns, over several by
/// the shortest way.
[[nodiscard]] Eigen::Vector3d rotation_between(const Motion& motion, double from, double to);

/// The rotation vector that leads a body to where its motion is, also from where it is that fell
/// back behind it: then by the shortest way.
///
/// A turn of less than 3 rad leads there, but for rounding. A longer turn keeps its axis: it makes
/// good where the body is behind or ahead about that axis, and nothing else.
///
/// @param rotation  of the body now
[[nodiscard]] Eigen::Vector3d rotation_along(const Motion& motion, double from, double to,
                                             const Eigen::Quaterniond& rotation);

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
