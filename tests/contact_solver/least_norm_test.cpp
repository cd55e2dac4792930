// Impulses that the laws leave open.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kLeastNormTolerance = 1e-9;

/// A leg of a table: a place on the ground, and how fast the ground runs there.
struct Leg {
  double x;
  double y;
  Eigen::Vector2d belt = Eigen::Vector2d::Zero();
};

/// A table of 1 kg on the ground (body 0), with its centre 0.5 m above, that falls at 0.1 m/s.
ContactProblem table(const std::vector<Leg>& legs, double friction) {
  ContactProblem problem;
  problem.bodies.resize(2);
  problem.bodies[1].inverse_inertia.mass.setOnes();
  problem.bodies[1].inverse_inertia.rotation = Vector3d(6.0, 2.4, 2.4).asDiagonal();
  problem.bodies[1].v = {0.0, 0.0, -0.1};
  for (const Leg& leg : legs) {
    ContactPoint contact;
    contact.bodies = {0, 1};
    contact.arm_A = {leg.x, leg.y, 0.5};
    contact.arm_B = {leg.x, leg.y, -0.5};
    contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    contact.friction = friction;
    contact.sticking_velocity = leg.belt;
    problem.contacts.push_back(contact);
  }
  return problem;
}

ContactSolution solved(const ContactProblem& problem,
                       ProjectionSpace space = ProjectionSpace::automatic) {
  return project_on_contacts(problem,
                             {.tolerance = kLeastNormTolerance, .space = space, .sweeps = 100000});
}

double squared_norm(const ContactSolution& solution) {
  double sum = 0.0;
  for (const Vector3d& impulse : solution.impulses) {
    sum += impulse.squaredNorm();
  }
  return sum;
}

const std::vector<Leg> kFourLegs{{-1, -0.5}, {1, -0.5}, {-1, 0.5}, {1, 0.5}};

TEST(LeastNorm, FourLegsCarryTheSame) {
  for (const double friction : {0.0, 0.5}) {
    const ContactSolution solution = solved(table(kFourLegs, friction));
    EXPECT_LE(solution.residual, kLeastNormTolerance);
    for (const Vector3d& impulse : solution.impulses) {
      EXPECT_NEAR((impulse - Vector3d(0.025, 0.0, 0.0)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(LeastNorm, DoesNotDependOnTheOrderOfContacts) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    std::vector<Leg> legs;
    for (int k = 0; k < 7; ++k) {
      legs.push_back({place(rng), place(rng)});
    }
    ContactProblem problem = table(legs, i % 2 == 0 ? 0.0 : 0.6);
    problem.bodies[1].w = {0.03 * place(rng), 0.03 * place(rng), 0.03 * place(rng)};
    const ContactSolution solution = solved(problem);
    std::reverse(problem.contacts.begin(), problem.contacts.end());
    const ContactSolution reversed = solved(problem);
    ASSERT_LE(solution.residual, kLeastNormTolerance) << i;
    ASSERT_LE(reversed.residual, kLeastNormTolerance) << i;
    if (i % 2 == 1) {
      continue;  // With friction the laws alone are promised.
    }
    for (std::size_t k = 0; k < legs.size(); ++k) {
      ASSERT_NEAR((solution.impulses[k] - reversed.impulses[legs.size() - 1 - k]).norm(), 0.0, 1e-7)
          << i << " " << k;
    }
    ASSERT_LE(squared_norm(solution),
              squared_norm(solved(problem, ProjectionSpace::contact)) + 1e-9)
        << i;
  }
}

// A plank on two belts that run against each other. All four contacts slide, so unequal shares
// would turn it.
TEST(LeastNorm, BeltsAgainstEachOtherDoNotTurnAPlank) {
  for (const double x : {0.0, 0.1, 0.6}) {
    std::vector<Leg> legs;
    for (const Leg& leg : kFourLegs) {
      legs.push_back({leg.x - x, leg.y, {leg.x < 0.0 ? 2.0 : -2.0, 0.0}});
    }
    const ContactSolution solution = solved(table(legs, 0.3));
    EXPECT_LE(solution.residual, kLeastNormTolerance);
    EXPECT_NEAR(solution.bodies[1].w.z(), 0.0, 1e-9) << x;
    EXPECT_NEAR(solution.bodies[1].v.y(), 0.0, 1e-9) << x;
    EXPECT_NEAR(solution.impulses[0].x(), solution.impulses[2].x(), 1e-9) << x;
    EXPECT_NEAR(solution.impulses[1].x(), solution.impulses[3].x(), 1e-9) << x;
  }
}

// On a slope near the angle of friction equal shares of friction would slip uphill, where legs
// carry less.
TEST(LeastNorm, FrictionOnASlopeIsSharedByLoad) {
  ContactProblem problem = table(kFourLegs, 0.5);
  problem.bodies[1].v = {0.045, 0.0, -0.1};
  const ContactSolution solution = solved(problem);
  EXPECT_LE(solution.residual, kLeastNormTolerance);
  EXPECT_NEAR(solution.bodies[1].v.norm(), 0.0, 1e-8);
  EXPECT_NEAR((solution.impulses[0] - solution.impulses[2]).norm(), 0.0, 1e-4);
  EXPECT_NEAR((solution.impulses[1] - solution.impulses[3]).norm(), 0.0, 1e-4);
  EXPECT_GT(solution.impulses[1].x(), 1.2 * solution.impulses[0].x());
}

// A leg beyond the kern of the others would have to pull.
TEST(LeastNorm, NoLegPulls) {
  std::vector<Leg> legs;
  for (const Leg& leg : kFourLegs) {
    legs.push_back({leg.x - 0.65, leg.y - 0.325});
  }
  const ContactSolution solution = solved(table(legs, 0.0));
  EXPECT_LE(solution.residual, kLeastNormTolerance);
  EXPECT_NEAR(solution.impulses[0].x(), 0.0, 1e-12);
  EXPECT_NEAR(solution.impulses[1].x(), solution.impulses[2].x(), 1e-9);
}

TEST(LeastNorm, KeepsWhatTheLawsDetermine) {
  // Three legs: the answer of the sweeps, bit for bit.
  const ContactProblem problem = table({{-1, -0.5}, {1, -0.4}, {0.1, 0.5}}, 0.0);
  const ContactSolution solution = solved(problem);
  const ContactSolution swept = solved(problem, ProjectionSpace::contact);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(solution.impulses[k], swept.impulses[k]);
  }
  EXPECT_EQ(solution.bodies[1].v, swept.bodies[1].v);
}

}  // namespace
}  // namespace firstcontact
