#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/kinetics.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d random_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return {normal(rng), normal(rng), normal(rng)};
}

Pose random_pose(std::mt19937& rng) {
  std::normal_distribution<double> n;
  return {random_vector(rng), Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng))};
}

/// Inertia of a body of some points, whose principal axes are no coordinate axes.
Inertia random_inertia(std::mt19937& rng) {
  Inertia inertia;
  inertia.mass = std::exp(random_vector(rng).x());
  inertia.about_C_B.setZero();
  for (int k = 0; k < 5; ++k) {
    const Vector3d p = random_vector(rng);
    inertia.about_C_B += p.squaredNorm() * Matrix3d::Identity() - p * p.transpose();
  }
  return inertia;
}

/// Bit k locks axis k.
std::array<bool, 3> locks(unsigned bits) {
  return {(bits & 1) > 0, (bits & 2) > 0, (bits & 4) > 0};
}

TEST(InverseInertia, IsTheInverseWhereNothingIsLocked) {
  std::mt19937 rng(1);
  for (int i = 0; i < 100; ++i) {
    const Inertia inertia = random_inertia(rng);
    const Pose X_WB = random_pose(rng);
    const InverseInertia inverse = inverse_inertia(inertia, X_WB);
    const Matrix3d one = inverse.rotation * rotational_inertia(inertia, X_WB);
    ASSERT_LE((one - Matrix3d::Identity()).norm(), 1e-9) << i;
    ASSERT_LE((inverse.mass * inertia.mass - Vector3d::Ones()).norm(), 1e-14) << i;
  }
}

TEST(InverseInertia, OfLockedTranslationsIsZero) {
  std::mt19937 rng(2);
  Inertia inertia = random_inertia(rng);
  for (unsigned bits = 0; bits < 8; ++bits) {
    inertia.locked_translation = locks(bits);
    const InverseInertia inverse = inverse_inertia(inertia, random_pose(rng));
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(inverse.mass[k], inertia.locked_translation[k] ? 0.0 : 1.0 / inertia.mass);
    }
  }
}

// Newton's law: a torque turns the body about no locked axis, and what holds it there is a torque
// about locked axes alone.
TEST(InverseInertia, AnswersTorquesAboutFreeAxesAlone) {
  std::mt19937 rng(3);
  for (unsigned i = 0; i < 400; ++i) {
    Inertia inertia = random_inertia(rng);
    inertia.locked_rotation = locks(i % 8);
    const Pose X_WB = random_pose(rng);
    const Vector3d torque = random_vector(rng);
    const Vector3d turning = inverse_inertia(inertia, X_WB).rotation * torque;
    const Vector3d holding = rotational_inertia(inertia, X_WB) * turning - torque;
    for (int k = 0; k < 3; ++k) {
      if (inertia.locked_rotation[k]) {
        ASSERT_EQ(turning[k], 0.0) << i;
      } else {
        ASSERT_LE(std::abs(holding[k]), 1e-10 * torque.norm()) << i;
      }
    }
  }
}

TEST(InverseInertia, IsSymmetricAndNeverNegative) {
  std::mt19937 rng(4);
  for (unsigned i = 0; i < 400; ++i) {
    Inertia inertia = random_inertia(rng);
    inertia.locked_rotation = locks(i % 8);
    const Matrix3d inverse = inverse_inertia(inertia, random_pose(rng)).rotation;
    ASSERT_LE((inverse - inverse.transpose()).norm(), 1e-15 * inverse.norm()) << i;
    const Vector3d torque = random_vector(rng);
    ASSERT_GE(torque.dot(inverse * torque), -1e-15 * inverse.norm()) << i;
  }
}

TEST(InverseInertia, OfARodAboutOneFreeAxisIsThatOfItsSlantedLength) {
  // A rod of length 2 m and 3 kg in the plane of y and z, 30 degrees from z, turns about z alone.
  Inertia inertia;
  inertia.mass = 3.0;
  inertia.about_C_B = Vector3d(1.0, 1.0, 1e-12).asDiagonal();
  inertia.locked_rotation = {true, true, false};
  const double slant = std::acos(-1.0) / 6.0;
  const Pose X_WB{{}, Eigen::Quaterniond(Eigen::AngleAxisd(slant, Vector3d::UnitX()))};
  const Matrix3d inverse = inverse_inertia(inertia, X_WB).rotation;
  EXPECT_NEAR(inverse(2, 2), 4.0, 1e-9);  // 1 / (1 kg m^2 sin^2 30 degrees)
  EXPECT_EQ(inverse.cwiseAbs().sum(), inverse(2, 2));
}

/// A body that turns for a second.
RigidState turned(const Inertia& inertia, RigidState state, int steps,
                  const Vector3d& torque = Vector3d::Zero()) {
  for (int k = 0; k < steps; ++k) {
    const FreeTurn turn = free_turn(inertia, state, torque, 1.0 / steps);
    const double angle = turn.rotation_vector.norm();
    const Eigen::AngleAxisd by(angle, turn.rotation_vector.stableNormalized());
    state.X_WB.rotation = (by * state.X_WB.rotation).normalized();
    state.w_WB = turn.w_WB;
  }
  return state;
}

// A rod whose moments differ by a factor of 250,000 once gained 13,600 times its energy.
TEST(FreeTurn, OfAnyBodyKeepsEnergyAndMomentum) {
  std::mt19937 rng(7);
  for (int i = 0; i < 60; ++i) {
    Inertia inertia = random_inertia(rng);
    if (i % 3 > 0) {  // A box of sides of 1, 1e-3 and 1e-3 or 1e-4.
      const Vector3d squares(1.0, 1e-6, i % 3 == 1 ? 1e-6 : 1e-8);
      inertia.about_C_B = Matrix3d((squares.sum() * Vector3d::Ones() - squares).asDiagonal());
    }
    RigidState begin{.X_WB = random_pose(rng), .w_WB = 5.0 * random_vector(rng)};
    begin.X_WB.rotation.normalize();
    const Vector3d momentum = rotational_inertia(inertia, begin.X_WB) * begin.w_WB;
    const RigidState end = turned(inertia, begin, 20);
    ASSERT_NEAR(kinetic_energy(inertia, end) / kinetic_energy(inertia, begin), 1.0, 1e-9) << i;
    ASSERT_LE((rotational_inertia(inertia, end.X_WB) * end.w_WB - momentum).norm(),
              1e-11 * momentum.norm())
        << i;
  }
}

/// The orientation after a second, by Runge and Kutta's rule on the quaternion and the momentum.
Eigen::Quaterniond integrated(const Inertia& inertia, const RigidState& begin,
                              const Vector3d& torque) {
  constexpr int kParts = 4000;
  constexpr double kPart = 1.0 / kParts;
  const Vector3d momentum = rotational_inertia(inertia, begin.X_WB) * begin.w_WB;
  const auto rate = [&](const Eigen::Vector4d& q, double t) -> Eigen::Vector4d {
    const Pose X_WB{Vector3d::Zero(), Eigen::Quaterniond(q).normalized()};
    const Vector3d w = rotational_inertia(inertia, X_WB).inverse() * (momentum + t * torque);
    return 0.5 * (Eigen::Quaterniond(0.0, w.x(), w.y(), w.z()) * Eigen::Quaterniond(q)).coeffs();
  };
  Eigen::Vector4d q = begin.X_WB.rotation.coeffs();
  for (int k = 0; k < kParts; ++k) {
    const double t = k * kPart;
    const Eigen::Vector4d k1 = rate(q, t);
    const Eigen::Vector4d k2 = rate(q + 0.5 * kPart * k1, t + 0.5 * kPart);
    const Eigen::Vector4d k3 = rate(q + 0.5 * kPart * k2, t + 0.5 * kPart);
    const Eigen::Vector4d k4 = rate(q + kPart * k3, t + kPart);
    q += kPart / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return Eigen::Quaterniond(q).normalized();
}

// Steps of less than 0.04 rad have one sub-step each, so the order is that of the rule: fourth
// without a torque, third with one.
TEST(FreeTurn, IsOfHighOrderInItsSubSteps) {
  Inertia inertia;
  inertia.about_C_B = Vector3d(1.0, 2.0, 2.6).asDiagonal();
  RigidState begin{.X_WB = {{}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)}, .w_WB = {1.0, 3.0, 1.5}};
  for (const Vector3d& torque : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.5, -0.3, 0.4)}) {
    const Eigen::Quaterniond right = integrated(inertia, begin, torque);
    const auto error = [&](int steps) {
      const Eigen::Quaterniond end = turned(inertia, begin, steps, torque).X_WB.rotation;
      return 2.0 * (right.conjugate() * end).vec().norm();
    };
    const double coarse = error(100);
    EXPECT_LE(coarse, torque.isZero() ? 1e-7 : 2e-6);
    EXPECT_LE(error(200), coarse / (torque.isZero() ? 12.0 : 7.0) + 1e-13);
  }
}

TEST(FreeTurn, UnderATorqueAddsItToTheMomentum) {
  std::mt19937 rng(8);
  for (int i = 0; i < 20; ++i) {
    const Inertia inertia = random_inertia(rng);
    RigidState state{.X_WB = random_pose(rng), .w_WB = random_vector(rng)};
    state.X_WB.rotation.normalize();
    const Vector3d torque = random_vector(rng);
    const Vector3d momentum = rotational_inertia(inertia, state.X_WB) * state.w_WB + 0.5 * torque;
    const FreeTurn turn = free_turn(inertia, state, torque, 0.5);
    const Eigen::Quaterniond by(
        Eigen::AngleAxisd(turn.rotation_vector.norm(), turn.rotation_vector.normalized()));
    const Pose end{Vector3d::Zero(), by * state.X_WB.rotation};
    ASSERT_LE((rotational_inertia(inertia, end) * turn.w_WB - momentum).norm(), 1e-11) << i;
  }
}

// Nothing turns the body but what holds the locked axis: that does no work, and leaves the momentum
// about the others.
TEST(FreeTurn, AboutTwoAxesKeepsEnergyAndMomentum) {
  std::mt19937 rng(5);
  for (int i = 0; i < 20; ++i) {
    Inertia inertia = random_inertia(rng);
    inertia.locked_rotation = locks(1u << (i % 3));
    RigidState begin{.X_WB = random_pose(rng), .w_WB = random_vector(rng)};
    begin.X_WB.rotation.normalize();
    begin.w_WB[i % 3] = 0.0;
    const Vector3d momentum = rotational_inertia(inertia, begin.X_WB) * begin.w_WB;
    double before = 1e-5;
    for (const int steps : {200, 400}) {
      const RigidState end = turned(inertia, begin, steps);
      const Vector3d change = rotational_inertia(inertia, end.X_WB) * end.w_WB - momentum;
      ASSERT_EQ(end.w_WB[i % 3], 0.0) << i;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(k == i % 3 || std::abs(change[k]) <= 1e-11 * momentum.norm()) << i;
      }
      const double error =
          std::abs(kinetic_energy(inertia, end) / kinetic_energy(inertia, begin) - 1.0);
      ASSERT_LE(error, 0.3 * before + 1e-12) << i;  // The error is of second order in the step.
      before = error;
    }
  }
}

TEST(FreeTurn, AboutOneAxisIsSteady) {
  std::mt19937 rng(6);
  Inertia inertia = random_inertia(rng);
  inertia.locked_rotation = {true, false, true};
  const RigidState begin{.X_WB = random_pose(rng), .w_WB = {0.0, 3.0, 0.0}};
  const FreeTurn turn = free_turn(inertia, begin, Vector3d::Zero(), 0.5);
  EXPECT_LE((turn.rotation_vector - Vector3d(0.0, 1.5, 0.0)).norm(), 1e-12);
  EXPECT_LE((turn.w_WB - begin.w_WB).norm(), 1e-12);
}

}  // namespace
}  // namespace firstcontact
