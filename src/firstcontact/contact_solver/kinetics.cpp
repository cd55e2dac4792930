#include <firstcontact/contact_solver/kinetics.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>

namespace firstcontact {
namespace {

using detail::nearest_turn;
using detail::turn;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// [rad]  Turn of a sub-step. A body that needs more than kMostSubSteps spins faster than any
/// result of it matters: it goes on about the same axis.
constexpr double kSubStep = 0.04;  // [rad]
constexpr int kMostSubSteps = 10240;

constexpr int kIterations = 12;  // Each leaves about a twentieth of the error.

Matrix3d rotation(const Pose& X_WB) { return X_WB.rotation.normalized().toRotationMatrix(); }

/// A body that turns, by the implicit midpoint rule on the angular velocity in its axes,
///   I dW/dt = I W x W + torque.
/// The rule keeps energy and the length of the momentum. Its coefficients are differences of
/// principal moments divided by the third one, at most 1. So its steps are contractions to half the
/// sub-step's angle, for bodies of any shape. The orientation then follows the momentum.
class Tumbling {
 public:
  Tumbling(const Inertia& inertia, const RigidState& state, const Vector3d& torque_W)
      : I_(inertia.about_C_B),
        inverse_(I_.inverse()),
        torque_W_(torque_W),
        R_(state.X_WB.rotation.normalized()),
        w_B_(R_.conjugate() * state.w_WB),
        momentum_(R_ * (I_ * w_B_)) {}

  /// @param h  [s]  of either sign
  void advance(double h) {
    const Vector3d torque_B = R_.conjugate() * torque_W_;
    Vector3d halfway = w_B_;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const Vector3d turned = torque_B - 0.5 * h * halfway.cross(torque_B);
      halfway = w_B_ + 0.5 * h * (inverse_ * ((I_ * halfway).cross(halfway) + turned));
    }
    way_ += h * (R_ * halfway);
    w_B_ = 2.0 * halfway - w_B_;
    R_ = R_ * turn(h * halfway);
    momentum_ += h * torque_W_;
    const Vector3d reached = R_ * (I_ * w_B_);
    if (reached.squaredNorm() > 0.0 && momentum_.squaredNorm() > 0.0) {
      R_ = (Quaterniond::FromTwoVectors(reached, momentum_) * R_).normalized();
      w_B_ *= momentum_.norm() / reached.norm();
    }
  }

  [[nodiscard]] const Quaterniond& rotation() const { return R_; }
  [[nodiscard]] Vector3d velocity() const { return R_ * w_B_; }  // [rad/s]  In the world.
  [[nodiscard]] const Vector3d& way() const { return way_; }     // [rad]  Integral of the velocity.

 private:
  Matrix3d I_;
  Matrix3d inverse_;
  Vector3d torque_W_;
  Quaterniond R_;
  Vector3d w_B_;
  Vector3d momentum_;
  Vector3d way_ = Vector3d::Zero();
};

/// Integrates in sub-steps of the rule three times, of which one goes back. They are of fourth
/// order without a torque, and of third with one, as the rule turns a torque to first order only.
///
/// H. Yoshida, "Construction of higher order symplectic integrators" (Physics Letters A 150, 1990).
FreeTurn tumbling_turn(const Inertia& inertia, const RigidState& state, const Vector3d& torque_W,
                       double dt, int count) {
  const double outer = 1.0 / (2.0 - std::cbrt(2.0));
  Tumbling body(inertia, state, torque_W);
  for (int k = 0; k < count; ++k) {
    for (const double share : {outer, 1.0 - 2.0 * outer, outer}) {
      body.advance(share * dt / count);
    }
  }
  const Quaterniond begin = state.X_WB.rotation.normalized();
  return {nearest_turn(body.rotation() * begin.conjugate(), body.way()), body.velocity()};
}

/// Integrates the same rule on the momentum, in the world. The torque of a locked axis changes the
/// momentum about that axis alone, and the velocity does not depend on that part. Turns about free
/// axes add up to one about a locked axis, too, where the mean has none.
FreeTurn locked_turn(const Inertia& inertia, const RigidState& state, const Vector3d& torque_W,
                     double dt, int count) {
  const double h = dt / count;
  const auto velocity_at = [&](const Quaterniond& q, const Vector3d& L) -> Vector3d {
    return inverse_inertia(inertia, {Vector3d::Zero(), q}).rotation * L;
  };
  const Quaterniond begin = state.X_WB.rotation.normalized();
  Quaterniond R = begin;
  Vector3d momentum = rotational_inertia(inertia, state.X_WB) * state.w_WB;
  Vector3d w = state.w_WB;
  Vector3d mean = Vector3d::Zero();
  for (int k = 0; k < count; ++k) {
    const Vector3d halfway = momentum + 0.5 * h * torque_W;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      w = velocity_at(turn(0.5 * h * w) * R, halfway);
    }
    R = (turn(h * w) * R).normalized();
    momentum += h * torque_W;
    mean += w / count;
  }
  return {mean * dt, velocity_at(turn(mean * dt) * begin, momentum)};
}

}  // namespace

bool is_isotropic(const Inertia& inertia) {
  const Matrix3d& I = inertia.about_C_B;
  const double mean = I.trace() / 3.0;
  return (I - mean * Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-9 * mean;
}

bool is_locked(const Inertia& inertia) {
  return std::ranges::any_of(inertia.locked_rotation, [](bool lock) { return lock; });
}

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

Vector3d turned_along(const Inertia& inertia, const Vector3d& w_WB,
                      const Vector3d& rotation_vector) {
  if (is_locked(inertia) || is_isotropic(inertia)) {
    return w_WB;
  }
  return turn(rotation_vector) * w_WB;
}

double tumbling_acceleration(const Inertia& inertia, const RigidState& state) {
  if (is_isotropic(inertia)) {
    return 0.0;
  }
  const Vector3d momentum = rotational_inertia(inertia, state.X_WB) * state.w_WB;
  const Matrix3d inverse = inverse_inertia(inertia, state.X_WB).rotation;
  return (inverse * momentum.cross(state.w_WB)).norm();
}

FreeTurn free_turn(const Inertia& inertia, const RigidState& state, const Vector3d& torque_W,
                   double dt) {
  const double angle = state.w_WB.norm() * dt;
  if (is_isotropic(inertia) || angle == 0.0) {  // No gyroscopic moment.
    const Vector3d change = inverse_inertia(inertia, state.X_WB).rotation * torque_W * dt;
    return {(state.w_WB + 0.5 * change) * dt, state.w_WB + change};
  }
  const int count = static_cast<int>(std::max(1.0, std::ceil(angle / kSubStep)));
  if (angle > kSubStep * kMostSubSteps) {
    return {state.w_WB * dt, state.w_WB};
  }
  return is_locked(inertia) ? locked_turn(inertia, state, torque_W, dt, count)
                            : tumbling_turn(inertia, state, torque_W, dt, count);
}

}  // namespace firstcontact
