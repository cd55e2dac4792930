/// @file
/// A robot that moves straight from one configuration to another, as a planner asks for it.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/robot/robot_motion.h>

#include "tests/support/random.h"

namespace firstcontact::benchmarks {

/// Configurations have a number [rad or m] for every joint; that of a fixed joint, or of one that
/// mimics, has no meaning.
using Configuration = std::vector<double>;

struct StraightMotion {
  Configuration from;
  Configuration to;

  [[nodiscard]] RobotMotion of(const RobotModel& model) const;

  [[nodiscard]] double longest_joint() const;  ///< [rad or m]
  [[nodiscard]] Configuration at(double t) const;
};

/// Anywhere within the limits; half a turn where there are none.
[[nodiscard]] Configuration random_configuration(const RobotModel& model, test::Random& random);

/// From a configuration in a random direction of the revolute joints, within their limits.
///
/// @param length  [rad]  Euclidean; less where limits end the way
[[nodiscard]] StraightMotion random_motion(const RobotModel& model, const Configuration& from,
                                           double length, test::Random& random);

/// Forward kinematics in plain doubles, as fast as planners have it.
class PlainKinematics {
 public:
  explicit PlainKinematics(const RobotModel& model);

  /// X_WL of every link; valid until the next call.
  [[nodiscard]] const std::vector<Eigen::Isometry3d>& places(const Configuration& q);

 private:
  struct Step {
    std::size_t parent;
    std::size_t child;
    JointType type;
    Eigen::Isometry3d X_PJ;
    Eigen::Vector3d axis;
    std::size_t source;  // The joint whose coordinate it follows.
    double multiplier;
    double offset;
  };
  std::vector<Step> steps_;  // Parents first.
  std::vector<Eigen::Isometry3d> places_;
};

}  // namespace firstcontact::benchmarks
