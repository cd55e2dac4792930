// Problems that sweeps in single precision would not solve as exactly as is asked for: they are
// solved so all the same.

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>

#include "contact_solver/wall_problem.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void expect_solved(const ContactProblem& problem, double tolerance, ProjectionSpace space) {
  const ContactSolution solution =
      project_on_contacts(problem, {.tolerance = tolerance, .space = space});
  for (const ContactBody& body : solution.bodies) {
    ASSERT_TRUE(body.v.allFinite() && body.w.allFinite());
  }
  EXPECT_LE(contact_residual(problem, solution), tolerance) << static_cast<int>(space);
}

void heavier(double factor, ContactBody& body) {
  body.inverse_inertia.mass /= factor;
  body.inverse_inertia.rotation /= factor;
}

/// Bodies that move along x alone, each against a slanted face of one that does not; a few of them
/// heavier.
ContactProblem sliders(double degrees, double factor) {
  const double angle = degrees / 180.0 * std::numbers::pi;
  const Vector3d n(std::sin(angle), 0.6 * std::cos(angle), 0.8 * std::cos(angle));
  const Vector3d t(-std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle));
  Matrix3d frame;
  frame << n.transpose(), t.transpose(), n.cross(t).transpose();
  ContactProblem problem;
  problem.bodies.resize(1);
  for (std::size_t k = 0; k < 64; ++k) {
    ContactBody& body = problem.bodies.emplace_back();
    body.inverse_inertia.mass.x() = 1.0;
    body.v.x() = -1.0 - 0.01 * static_cast<double>(k);
    if (k % 16 == 3) {
      heavier(factor, body);
    }
    problem.contacts.push_back({.bodies = {0, k + 1}, .frame = frame, .friction = 0.4});
  }
  return problem;
}

// Responses across the locked axes are so small that their squares are 0 in single precision.
TEST(SinglePrecision, LeavesLockedAxesToDoubles) {
  for (const double degrees : {90.0, 60.0, 20.0}) {
    for (const double factor : {1.0, 1e7, 1e9}) {
      const ContactProblem problem = sliders(degrees, factor);
      expect_solved(problem, 1e-5, ProjectionSpace::automatic);
      if (degrees >= 60.0) {
        expect_solved(problem, 1e-5, ProjectionSpace::contact);
      }
    }
  }
}

TEST(SinglePrecision, LeavesTinyFrictionToDoubles) {
  for (const double friction : {1e-3, 1e-8, 1e-12, 1e-20}) {
    std::mt19937 rng(1);
    const ContactProblem problem = test::wall(rng, 3, 40, friction);
    expect_solved(problem, 1e-5, ProjectionSpace::automatic);
  }
}

/// Stacks side by side, with what holds them but for some noise as guesses.
ContactProblem stacks(std::size_t count, std::size_t height) {
  ContactProblem problem;
  problem.bodies.resize(1);
  for (std::size_t stack = 0; stack < count; ++stack) {
    for (std::size_t k = 0; k < height; ++k) {
      ContactBody& body = problem.bodies.emplace_back();
      body.inverse_inertia.mass.setOnes();
      body.inverse_inertia.rotation = Vector3d::Constant(6.0).asDiagonal();
      body.v.z() = -0.1;
      const std::size_t own = problem.bodies.size() - 1;
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          ContactPoint contact{.bodies = {k > 0 ? own - 1 : 0, own},
                               .arm_A = {x, y, 0.5},
                               .arm_B = {x, y, -0.5},
                               .friction = 0.5};
          contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
          contact.guess.x() = 0.025 * static_cast<double>(height - k) * (1.0 + 1e-5 * x);
          problem.contacts.push_back(contact);
        }
      }
    }
  }
  return problem;
}

// Impulses hold up much more than what changes, and single precision has no digits left for that.
TEST(SinglePrecision, LeavesWhatBearsAHeavyLoadToDoubles) {
  expect_solved(stacks(20, 100), 1e-6, ProjectionSpace::contact);
  for (const double friction : {0.0, 0.1, 0.5}) {
    std::mt19937 rng(4);
    const ContactProblem problem = test::wall_with_heavy_top(rng, 40, friction, 1e4);
    expect_solved(problem, 1e-6, ProjectionSpace::automatic);
    expect_solved(problem, 1e-4, ProjectionSpace::automatic);
  }
}

// Nor where sweeps in single precision were tried first and did not get there.
TEST(SinglePrecision, NeverEndsWorseThanItBegan) {
  const ContactProblem problem = stacks(20, 200);
  const detail::ContactRows rows(problem);
  for (const double tolerance : {1e-7, 1e-6, 1e-5}) {
    detail::Projection projection = test::nothing(problem, rows);
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      projection.impulses.contacts[k] = rows.contacts[k].own.turn() * problem.contacts[k].guess;
    }
    projection.velocities = detail::velocities_after(rows, projection.impulses);
    projection.residual =
        detail::greatest_residual(rows, projection.impulses, projection.velocities);
    const double before = projection.residual;
    detail::project_by_gauss_seidel(problem, rows, {.tolerance = tolerance, .sweeps = 50},
                                    projection);
    EXPECT_LE(projection.residual, before) << tolerance;
  }
}

}  // namespace
}  // namespace firstcontact
