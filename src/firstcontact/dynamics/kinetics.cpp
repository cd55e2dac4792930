#include <firstcontact/dynamics/kinetics.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/dynamics/detail/turn.h>

namespace firstcontact {
namespace {

using detail::nearest_turn;
using detail::turn;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Beyond some thousands of sub-steps in a step a body spins faster than any result of it matters.
constexpr double kSubStep = 0.1;  // [rad]
constexpr int kMostSubSteps = 4096;

Matrix3d rotation(const Pose& X_WB) { return X_WB.rotation.normalized().toRotationMatrix(); }

/// Whether every direction is a principal one: then the angular velocity is constant.
bool is_isotropic(const Matrix3d& I) {
  const double mean = I.trace() / 3.0;
  return (I - mean * Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-9 * mean;
}

}  // namespace

Vector3d centre_of_mass(const Inertia& inertia, const Pose& X_WB) {
  return X_WB.position + rotation(X_WB) * inertia.p_BC;
}

Matrix3d rotational_inertia(const Inertia& inertia, const Pose& X_WB) {
  const Matrix3d R = rotation(X_WB);
  return R * inertia.about_C_B * R.transpose();
}

InverseInertia inverse_inertia(const Inertia& inertia, const Pose& X_WB) {
  InverseInertia inverse;
  for (int k = 0; k < 3; ++k) {
    inverse.mass[k] = inertia.locked_translation[k] ? 0.0 : 1.0 / inertia.mass;
  }
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> free(3, 0);
  for (int k = 0; k < 3; ++k) {
    if (!inertia.locked_rotation[k]) {
      free.conservativeResize(3, free.cols() + 1);
      free.col(free.cols() - 1) = Matrix3d::Identity().col(k);
    }
  }
  if (free.cols() > 0) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> I =
        free.transpose() * rotational_inertia(inertia, X_WB) * free;
    inverse.rotation = free * I.llt().solve(free.transpose());
  }
  return inverse;
}

double kinetic_energy(const Inertia& inertia, const RigidState& state) {
  return 0.5 * inertia.mass * state.v_WC.squaredNorm() +
         0.5 * state.w_WB.dot(rotational_inertia(inertia, state.X_WB) * state.w_WB);
}

FreeTurn free_turn(const Inertia& inertia, const RigidState& state, const Vector3d& torque_W,
                   double dt) {
  const bool locked = std::ranges::any_of(inertia.locked_rotation, [](bool lock) { return lock; });
  const double angle = state.w_WB.norm() * dt;
  if (is_isotropic(inertia.about_C_B) || angle == 0.0) {  // No gyroscopic moment.
    const Vector3d change = inverse_inertia(inertia, state.X_WB).rotation * torque_W * dt;
    return {(state.w_WB + 0.5 * change) * dt, state.w_WB + change};
  }
  const int count = static_cast<int>(
      std::clamp(std::ceil(angle / kSubStep), 1.0, static_cast<double>(kMostSubSteps)));
  const double h = dt / count;
  const Matrix3d inverse_B = inertia.about_C_B.inverse();
  Quaterniond R = state.X_WB.rotation.normalized();
  const Quaterniond begin = R;
  Vector3d momentum = rotational_inertia(inertia, state.X_WB) * state.w_WB;
  // What holds a locked axis changes the momentum about that axis alone, on which the velocity does
  // not depend.
  const auto velocity_at = [&](const Quaterniond& q, const Vector3d& L) -> Vector3d {
    return locked ? Vector3d(inverse_inertia(inertia, {Vector3d::Zero(), q}).rotation * L)
                  : Vector3d(q * (inverse_B * (q.conjugate() * L)));
  };
  Vector3d w = state.w_WB;
  Vector3d mean = Vector3d::Zero();
  for (int k = 0; k < count; ++k) {
    const Vector3d halfway = momentum + 0.5 * h * torque_W;
    // A contraction by about half the sub-step's angle.
    for (int iteration = 0; iteration < 12; ++iteration) {
      w = velocity_at(turn(0.5 * h * w) * R, halfway);
    }
    R = (turn(h * w) * R).normalized();
    momentum += h * torque_W;
    mean += w / count;
  }
  if (locked) {
    // Turns about free axes add up to one about a locked axis, too: the mean is about none.
    return {mean * dt, velocity_at(turn(mean * dt) * begin, momentum)};
  }
  return {nearest_turn(R * begin.conjugate(), mean * dt), velocity_at(R, momentum)};
}

}  // namespace firstcontact
