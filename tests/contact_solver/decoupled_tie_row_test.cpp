// Pins on long arms of small bodies: an impulse turns them and moves them little, so rows of a pin
// almost agree.

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>

#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Random;

/// A body of 1 kg whose moments of inertia [kg m^2] are equal.
ContactBody ball_of(double inertia, Random& random) {
  ContactBody body;
  body.inverse_inertia.mass = Vector3d::Ones();
  body.inverse_inertia.rotation = Matrix3d::Identity() / inertia;
  body.v = random.vector(0.0, 2.0);
  body.w = random.vector(0.0, 2.0);
  return body;
}

/// Adds the rows of a pin between a body and the world.
void pin(std::size_t body, const Vector3d& arm, ContactProblem& problem) {
  for (int k = 0; k < 3; ++k) {
    TieSide side{.body = body};
    side.row << Vector3d::Unit(k), arm.cross(Vector3d::Unit(k));
    problem.ties.push_back({.sides = {side}});
  }
}

/// Adds the rows of a pin between two bodies.
void pin(std::size_t a, const Vector3d& arm_A, std::size_t b, const Vector3d& arm_B,
         ContactProblem& problem) {
  for (int k = 0; k < 3; ++k) {
    TieSide A{.body = a};
    A.row << -Vector3d::Unit(k), -arm_A.cross(Vector3d::Unit(k));
    TieSide B{.body = b};
    B.row << Vector3d::Unit(k), arm_B.cross(Vector3d::Unit(k));
    problem.ties.push_back({.sides = {A, B}});
  }
}

// The angular momentum about the pin stays: I w + m c x v, with v = w x c.
TEST(DecoupledTieRow, APinnedPointMassKeepsItsAngularMomentum) {
  Random random(41);
  for (int i = 0; i < 200; ++i) {
    const double inertia = random.logarithmic(1e-12, 1e-2);
    const Vector3d arm = random.vector(0.5, 2.0);
    ContactProblem problem{.bodies = {ball_of(inertia, random)}};
    pin(0, arm, problem);
    const ContactBody& before = problem.bodies[0];
    const Vector3d momentum = inertia * before.w - arm.cross(before.v);
    const Vector3d along = arm.normalized();  // The spin about the arm has the inertia alone.
    const auto across = [&](const Vector3d& v) -> Vector3d { return v - along * along.dot(v); };
    const Vector3d w = across(momentum) / (inertia + arm.squaredNorm());
    const ContactSolution found = project_on_contacts(problem);
    EXPECT_LE(found.residual, 1e-9) << inertia;
    EXPECT_LE((across(found.bodies[0].w) - w).norm(), 1e-8) << inertia;
    EXPECT_LE((found.bodies[0].v + w.cross(arm)).norm(), 1e-8) << inertia;
  }
}

// A chain of them whose last body slides on a floor.
TEST(DecoupledTieRow, AChainOfPointMassesOnAFloorIsSolved) {
  Random random(42);
  for (int i = 0; i < 50; ++i) {
    const std::size_t n = 2 + static_cast<std::size_t>(i % 4);
    ContactProblem problem;
    for (std::size_t k = 0; k < n; ++k) {
      problem.bodies.push_back(ball_of(random.logarithmic(1e-10, 1e-7), random));
    }
    pin(0, random.vector(0.5, 1.0), problem);
    for (std::size_t k = 1; k < n; ++k) {
      const Vector3d arm = random.vector(0.5, 1.0);
      pin(k - 1, arm, k, random.vector(0.5, 1.0), problem);
    }
    problem.bodies.push_back({});  // The floor.
    problem.contacts.push_back(
        {.bodies = {n, n - 1},
         .arm_B = {0.0, 0.0, -1e-4},
         .frame = Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix(),
         .friction = 0.3});
    const ContactSolution found = project_on_contacts(problem, {.tolerance = 1e-7});
    EXPECT_LE(found.residual, 1e-7) << i;
    EXPECT_LE(contact_residual(problem, found), 1e-5) << i;  // Impulses in the rows of the pins.
  }
}

}  // namespace
}  // namespace firstcontact
