/// @file
/// Rotations and rotation vectors, in plain floating point.

#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::detail {

/// The rotation by the angle |vector| [rad] about the vector.
[[nodiscard]] inline Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) noexcept {
  const double square = vector.squaredNorm();
  if (square < 1e-6) {  // The series leaves out less than 1e-17.
    const double w = 1.0 - square / 8.0 + square * square / 384.0;
    const Eigen::Vector3d xyz = (0.5 - square / 48.0 + square * square / 3840.0) * vector;
    return {w, xyz.x(), xyz.y(), xyz.z()};
  }
  const double angle = std::sqrt(square);
  const Eigen::Vector3d xyz = (std::sin(0.5 * angle) / angle) * vector;
  return {std::cos(0.5 * angle), xyz.x(), xyz.y(), xyz.z()};
}

/// The rotation vector of at most half a turn [rad].
[[nodiscard]] inline Eigen::Vector3d vector_of(const Eigen::Quaterniond& rotation) noexcept {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double sine = rotation.vec().norm();
  const double cosine = sign * rotation.w();
  const double factor = sine > 1e-8 ? 2.0 * std::atan2(sine, cosine) / sine : 2.0 / cosine;
  return sign * factor * rotation.vec();
}

}  // namespace firstcontact::detail
