/// @file
/// Random motion of a robot and poses of its links in plain doubles, by forward kinematics that
/// shares no code with the library.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/robot/robot_motion.h>

#include "support/random.h"

namespace firstcontact::test {

/// Motion in which every joint goes from one value to another at a constant rate.
///
/// Joints are revolute, continuous, prismatic or fixed; some mimic another.
struct PlainRobotMotion {
  RobotModel model;
  std::vector<double> from;  ///< [rad or m]  Value of every joint; without meaning for those that
                             ///< mimic.
  std::vector<double> to;

  /// Computes X_WL(t) of every link.
  [[nodiscard]] std::vector<Eigen::Isometry3d> places(double t) const;

  /// Returns the same motion in the library's type.
  [[nodiscard]] RobotMotion motion() const;
};

/// Makes a motion that starts within the limits (half a turn where there are none).
///
/// A spread of 0 starts at 0 or the limit next to it, a spread of 1 anywhere. No joint goes farther
/// than `most` [rad or m].
PlainRobotMotion random_motion(const RobotModel& model, Random& random, double spread, double most);

}  // namespace firstcontact::test
