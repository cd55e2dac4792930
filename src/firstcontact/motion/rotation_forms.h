/// @file
/// Poses from other forms than quaternions, converted in double precision.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// Makes a rotation about the fixed axes x, then y, then z.
///
/// @param angles  [rad]
[[nodiscard]] FIRSTCONTACT_API Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& angles);

/// Makes a rotation from its vector.
///
/// @param rotation_vector  [rad]  axis times angle
[[nodiscard]] FIRSTCONTACT_API Eigen::Quaterniond rotation_from_vector(
    const Eigen::Vector3d& rotation_vector);

/// Makes the pose of a homogeneous matrix.
///
/// @param matrix  [-, m]  a rotation to within 1e-9, the position, and 0 0 0 1 as the last row
/// @throws std::invalid_argument if it is no such matrix
[[nodiscard]] FIRSTCONTACT_API Pose pose_from_matrix(const Eigen::Matrix4d& matrix);

}  // namespace firstcontact
