#include <firstcontact/dynamics/detail/project_again.h>

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLevels = 5;

/// Cubes of side 1 m on top of each other.
void add_stack(ContactProblem& problem) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    ContactBody body;
    body.inverse_inertia.mass.setOnes();
    body.inverse_inertia.rotation = 6.0 * Eigen::Matrix3d::Identity();
    body.v = {0.01, 0.0, -0.1};
    problem.bodies.push_back(body);
    const std::size_t above = problem.bodies.size() - 1;
    for (int corner = 0; corner < 4; ++corner) {
      ContactPoint contact;
      contact.bodies = {level == 0 ? 0 : above - 1, above};
      contact.arm_B = {(corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5, -0.5};
      contact.arm_A = contact.arm_B + Vector3d(0.0, 0.0, level == 0 ? 0.0 : 1.0);
      contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      contact.friction = 0.5;
      problem.contacts.push_back(contact);
    }
  }
}

/// Two stacks on the ground, solved; the guesses are the impulses.
struct Solved {
  Solved() {
    problem.bodies.resize(1);
    add_stack(problem);
    add_stack(problem);
    solution = project_on_contacts(problem, {.tolerance = 1e-12});
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      problem.contacts[k].guess = solution.impulses[k];
    }
  }

  ContactProblem problem;
  ContactSolution solution;
};

double difference(const ContactBody& x, const ContactBody& y) {
  return (x.v - y.v).norm() + (x.w - y.w).norm();
}

TEST(ProjectAgain, LeavesAloneWhatIsNotReached) {
  Solved c;
  c.problem.contacts[0].least_normal_velocity = 0.05;
  const ContactSolution again =
      project_again(c.problem, c.solution.bodies, {0}, {.tolerance = 1e-4, .sweeps = 100});
  EXPECT_GT(difference(again.bodies[1], c.solution.bodies[1]), 0.01);
  for (std::size_t b = 1 + kLevels; b < c.problem.bodies.size(); ++b) {
    EXPECT_EQ(again.bodies[b].v, c.solution.bodies[b].v) << b;
    EXPECT_EQ(again.bodies[b].w, c.solution.bodies[b].w) << b;
  }
}

TEST(ProjectAgain, MeetsTheLawsOfTheWhole) {
  Solved c;
  for (const std::size_t k : {0u, 1u}) {
    c.problem.contacts[k].least_normal_velocity = 0.05;
  }
  const ContactSolution again =
      project_again(c.problem, c.solution.bodies, {0, 1}, {.tolerance = 1e-9, .sweeps = 10000});
  EXPECT_LE(again.residual, 1e-7);
  EXPECT_NEAR(contact_residual(c.problem, again), again.residual, 1e-12);
}

TEST(ProjectAgain, TakesNewContactsAndBodies) {
  Solved c;
  c.problem.bodies.emplace_back();  // At rest, around the island.
  ContactPoint contact = c.problem.contacts.back();
  contact.bodies = {kLevels, c.problem.bodies.size() - 1};  // On top of the first stack.
  contact.arm_A = {0.2, 0.1, 0.5};
  contact.guess.setZero();
  contact.least_normal_velocity = 0.02;
  c.problem.contacts.push_back(contact);
  const ContactSolution again =
      project_again(c.problem, c.solution.bodies, {c.problem.contacts.size() - 1},
                    {.tolerance = 1e-9, .sweeps = 10000});
  // It would have to go into the ground: contacts hold it back, or the residual says so.
  EXPECT_EQ(contact_residual(c.problem, again), again.residual);
  EXPECT_EQ(again.impulses.size(), c.problem.contacts.size());
}

TEST(ProjectAgain, StopsAfterSoManySweeps) {
  Solved c;
  c.problem.contacts[0].least_normal_velocity = 0.05;
  const ContactSolution again =
      project_again(c.problem, c.solution.bodies, {0}, {.tolerance = 1e-300, .sweeps = 1});
  EXPECT_GT(again.residual, 1e-9);
  EXPECT_NEAR(contact_residual(c.problem, again), again.residual, 1e-12);
}

}  // namespace
}  // namespace firstcontact::detail
