/// @file
/// The pose of a body in the world.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact {

/// X_WB: maps a point of body B to the world, p_WP = position + R(rotation) p_BP.
///
/// The rotation means the quaternion divided by its exact length, so that any finite,
/// non-zero quaternion names an exact rigid transform, whatever its rounding.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< [m]  p_WB.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< [-]  R_WB; finite, not zero.
};

}  // namespace firstcontact
