/// @file
/// Spatial vectors of rigid bodies (R. Featherstone, "Rigid Body Dynamics Algorithms", 2008): the
/// linear part first.

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_description.h>

namespace firstcontact::detail {

/// A spatial vector: the linear part, then the angular one.
using Spatial = Eigen::Matrix<double, 6, 1>;

/// The matrix of the cross product with v.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

inline Spatial spatial(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  Spatial s;
  s << linear, angular;
  return s;
}

/// Computes the rate of a motion vector that a moving frame carries along.
inline Spatial cross_motion(const Spatial& V, const Spatial& m) {
  const Eigen::Vector3d v = V.head<3>();
  const Eigen::Vector3d w = V.tail<3>();
  return spatial(w.cross(m.head<3>()) + v.cross(m.tail<3>()), w.cross(m.tail<3>()));
}

/// Computes the rate of a force or momentum that a moving frame carries along.
inline Spatial cross_force(const Spatial& V, const Spatial& f) {
  const Eigen::Vector3d v = V.head<3>();
  const Eigen::Vector3d w = V.tail<3>();
  return spatial(w.cross(f.head<3>()), v.cross(f.head<3>()) + w.cross(f.tail<3>()));
}

/// Computes the spatial inertia of a link about a point, (6, 6).
inline Eigen::Matrix<double, 6, 6> spatial_inertia(const LinkInertia& inertia, const Pose& X_WL,
                                                   const Eigen::Vector3d& about) {
  const Eigen::Matrix3d R = X_WL.rotation.toRotationMatrix();
  const Eigen::Vector3d c = X_WL.position + R * inertia.p_LC - about;
  const Eigen::Matrix3d C = cross_matrix(c);
  Eigen::Matrix<double, 6, 6> I;
  I.topLeftCorner<3, 3>() = inertia.mass * Eigen::Matrix3d::Identity();
  I.topRightCorner<3, 3>() = -inertia.mass * C;
  I.bottomLeftCorner<3, 3>() = inertia.mass * C;
  I.bottomRightCorner<3, 3>() = R * inertia.about_C_L * R.transpose() - inertia.mass * C * C;
  return I;
}

/// Solves with a mass matrix, or with a definite one near a singular one.
template <class Forces>
Forces solve_mass(const Eigen::MatrixXd& M, const Forces& forces) {
  const Eigen::LLT<Eigen::MatrixXd> factor(M);
  if (factor.info() == Eigen::Success) {
    return factor.solve(forces);
  }
  constexpr double kAdded = 1e-12;  // [-]
  const double added = kAdded * M.diagonal().maxCoeff();
  return (M + added * Eigen::MatrixXd::Identity(M.rows(), M.cols())).llt().solve(forces);
}

}  // namespace firstcontact::detail
