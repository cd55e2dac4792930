/// @file
/// The ellipsoid that a shape is.

#pragma once

#include <optional>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {

/// An ellipsoid along the axes of a body.
struct RoundEllipsoid {
  Eigen::Vector3d centre_B = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();     ///< [m]

  /// [m]  The farthest point along a direction, from the centre; axes of the body.
  [[nodiscard]] Eigen::Vector3d farthest(const Eigen::Vector3d& outwards_B) const {
    const Eigen::Vector3d stretched = radii.cwiseProduct(outwards_B);
    return radii.cwiseProduct(stretched / stretched.norm());
  }

  /// [m^2]  The matrix S of its support function, sqrt(n . S n), with the body's rotation.
  [[nodiscard]] Eigen::Matrix3d squares(const Eigen::Matrix3d& R_WB) const {
    const Eigen::Matrix3d axes = R_WB * radii.asDiagonal();
    return axes * axes.transpose();
  }

  /// [m]  The change of that point with the direction, a unit vector: the second derivative of the
  /// support function.
  ///
  /// Its eigenvalues along the surface are the principal radii of curvature.
  [[nodiscard]] Eigen::Matrix3d bend(const Eigen::Vector3d& outwards_B) const {
    const Eigen::Vector3d point = farthest(outwards_B);
    const Eigen::Matrix3d squares = radii.cwiseAbs2().asDiagonal();
    return (squares - point * point.transpose()) / point.dot(outwards_B);
  }
};

/// The ellipsoid that a shape is; none where the shape is no ellipsoid.
[[nodiscard]] std::optional<RoundEllipsoid> round_ellipsoid_of(const Shape& shape);

}  // namespace firstcontact::detail
