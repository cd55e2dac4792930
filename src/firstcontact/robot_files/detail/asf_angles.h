/// @file
/// Angles as Acclaim's files have them.

#pragma once

#include <numbers>

#include <Eigen/Geometry>

namespace firstcontact::detail {

inline constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]

/// The rotation about the fixed axes x, then y, then z.
inline Eigen::Quaterniond turned_xyz(const Eigen::Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

}  // namespace firstcontact::detail
