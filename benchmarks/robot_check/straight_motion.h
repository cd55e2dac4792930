/// @file
/// Straight motion of a robot from one configuration to another, as a planner needs it.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/robot/robot_motion.h>

#include "tests/support/random.h"

namespace firstcontact::benchmarks {

/// Configuration with a number [rad or m] for every joint.
///
/// The number of a fixed joint, or of one that mimics another, has no meaning.
using Configuration = std::vector<double>;

struct StraightMotion {
  Configuration from;
  Configuration to;

  [[nodiscard]] RobotMotion of(const RobotModel& model) const;

  [[nodiscard]] double longest_joint() const;  ///< [rad or m]
  [[nodiscard]] Configuration at(double t) const;
};

/// Draws a configuration within the limits; within half a turn where there are none.
[[nodiscard]] Configuration random_configuration(const RobotModel& model, test::Random& random);

/// Makes a motion from a configuration in a random direction of the revolute joints, within their
/// limits.
///
/// @param length  [rad]  Euclidean; the motion is shorter where a limit ends it
[[nodiscard]] StraightMotion random_motion(const RobotModel& model, const Configuration& from,
                                           double length, test::Random& random);

/// Forward kinematics in plain doubles, as fast as that of planners.
class PlainKinematics {
 public:
  explicit PlainKinematics(const RobotModel& model);

  /// Returns X_WL of every link; valid until the next call.
  [[nodiscard]] const std::vector<Eigen::Isometry3d>& places(const Configuration& q);

 private:
  struct Step {
    std::size_t parent;
    std::size_t child;
    JointType type;
    Eigen::Isometry3d X_PJ;
    Eigen::Vector3d axis;
    std::size_t source;  // The joint whose coordinate this joint follows.
    double multiplier;
    double offset;
  };
  std::vector<Step> steps_;  // Parents stand before their children.
  std::vector<Eigen::Isometry3d> places_;
};

}  // namespace firstcontact::benchmarks
