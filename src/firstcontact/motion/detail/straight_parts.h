/// @file
/// Divides a step into parts in which bodies with a given motion move almost straight.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/motion/motion.h>

namespace firstcontact::detail {

/// A body with a motion of its own, which a step follows.
struct ScriptedMotion {
  Motion motion;
  double reach = 0.0;  ///< [m]  Radius about the origin of the body that contains the body.
};

/// Computes the rotation vector over a part of a motion. Within one piece it has all turns; over
/// several pieces it is the shortest rotation.
[[nodiscard]] Eigen::Vector3d rotation_between(const Motion& motion, double from, double to);

/// Computes the rotation vector that turns a body to the orientation of its motion.
///
/// A turn of less than 3 rad reaches that orientation, but for rounding. A longer turn keeps its
/// axis: it corrects the error of the body about that axis, and nothing else. A body that fell back
/// behind its motion turns by the shortest rotation.
///
/// @param rotation  of the body now
[[nodiscard]] Eigen::Vector3d rotation_along(const Motion& motion, double from, double to,
                                             const Eigen::Quaterniond& rotation);

/// [m]  Bounds the distance of any point of the body from its place on a straight piece. There the
/// origin moves on a line and the body turns at a constant rate (rotation_between).
///
/// Two bounds hold between two breaks of the motion. The vector between the origins has a second
/// derivative of at most rate^2 lever. The angle between the orientations changes at most at the
/// difference of the two rates. Rounding is not charged: `verify` proves the run by itself.
///
/// @param from, to  in [0, 1], from < to
[[nodiscard]] double bend_bound(const ScriptedMotion& script, double from, double to);

/// Divides a step into parts, each of which is straight to the tolerance for all scripts. Returns
/// their ends; the last one is `to`.
///
/// Parts end at breaks of a motion where there are any, else in the middle.
///
/// @param tolerance  [m]  > 0
/// @returns  nothing where more than 10,000 parts would be needed
[[nodiscard]] std::vector<double> straight_parts(const std::vector<ScriptedMotion>& scripts,
                                                 double from, double to, double tolerance);

}  // namespace firstcontact::detail
