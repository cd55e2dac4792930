/// @file
/// A random motion of a robot, and where its links are, in plain doubles: forward kinematics that
/// shares no code with the library's.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/robot/robot_motion.h>

#include "support/random.h"

namespace firstcontact::test {

/// Every joint goes from one value to another at a constant rate. Revolute, continuous, prismatic
/// and fixed joints, and those that mimic.
struct PlainRobotMotion {
  RobotModel model;
  std::vector<double> from;  ///< [rad or m]  Of every joint; without meaning for those that mimic.
  std::vector<double> to;

  /// X_WL(t) of every link.
  [[nodiscard]] std::vector<Eigen::Isometry3d> places(double t) const;

  /// The same, as the library takes it.
  [[nodiscard]] RobotMotion motion() const;
};

/// Starts within the limits (half a turn where there are none), at 0 or the limit next to it for a
/// spread of 0, anywhere for a spread of 1; no joint goes farther than `most` [rad or m].
PlainRobotMotion random_motion(const RobotModel& model, Random& random, double spread, double most);

}  // namespace firstcontact::test
