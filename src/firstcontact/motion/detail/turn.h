/// @file
/// Rotations and their vectors.

#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::detail {

/// The rotation by a rotation vector [rad].
[[nodiscard]] inline Eigen::Quaterniond turn(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) {
    return Eigen::Quaterniond::Identity();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

/// The rotation vector of q that is nearest to `expected`, among those with any number of turns.
[[nodiscard]] inline Eigen::Vector3d nearest_turn(const Eigen::Quaterniond& q,
                                                  const Eigen::Vector3d& expected) {
  constexpr double kWhole = 2.0 * std::numbers::pi;
  const double sine = q.vec().norm();
  if (!(sine > 0.0)) {
    const double turns = std::round(expected.norm() / kWhole);
    return turns > 0.0 ? Eigen::Vector3d(expected.normalized() * turns * kWhole)
                       : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  const Eigen::Vector3d axis = q.vec() / sine;
  const double angle = 2.0 * std::atan2(sine, q.w());
  const double turns = std::round((axis.dot(expected) - angle) / kWhole);
  return (angle + kWhole * turns) * axis;
}

}  // namespace firstcontact::detail
