#include <firstcontact/contact_solver/detail/re_solve.h>

#include <algorithm>
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

/// [N s]  How far M (v - v_free) = J^T r is missed, at most.
double imbalance(const ContactProblem& problem, const ContactSolution& solution) {
  double most = 0.0;
  for (std::size_t b = 1; b < problem.bodies.size(); ++b) {
    Vector3d v = problem.bodies[b].v;
    Vector3d w = problem.bodies[b].w;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      const ContactPoint& contact = problem.contacts[k];
      for (std::size_t side = 0; side < 2; ++side) {
        if (contact.bodies[side] == b) {
          const Vector3d impulse =
              (side == 0 ? -1.0 : 1.0) * (contact.frame.transpose() * solution.impulses[k]);
          const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
          const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
          v += inverse.mass.cwiseProduct(impulse);
          w += inverse.rotation * arm.cross(impulse);
        }
      }
    }
    most = std::max({most, (v - solution.bodies[b].v).norm(), (w - solution.bodies[b].w).norm()});
  }
  return most;
}

double difference(const ContactBody& x, const ContactBody& y) {
  return (x.v - y.v).norm() + (x.w - y.w).norm();
}

TEST(ReSolve, LeavesAloneWhatIsNotReached) {
  Solved c;
  c.problem.contacts[0].least_normal_velocity = 0.05;
  const ContactSolution again =
      re_solve(c.problem, c.solution, {0}, {.tolerance = 1e-4, .sweeps = 100});
  EXPECT_GT(difference(again.bodies[1], c.solution.bodies[1]), 0.01);
  for (std::size_t b = 1 + kLevels; b < c.problem.bodies.size(); ++b) {
    EXPECT_EQ(again.bodies[b].v, c.solution.bodies[b].v) << b;
    EXPECT_EQ(again.bodies[b].w, c.solution.bodies[b].w) << b;
  }
}

TEST(ReSolve, MeetsTheLawsOfTheWhole) {
  Solved c;
  for (const std::size_t k : {0u, 1u}) {
    c.problem.contacts[k].least_normal_velocity = 0.05;
  }
  const ContactSolution again =
      re_solve(c.problem, c.solution, {0, 1}, {.tolerance = 1e-9, .sweeps = 10000});
  EXPECT_LE(again.residual, 1e-7);
  EXPECT_NEAR(contact_residual(c.problem, again), again.residual, 1e-12);
  EXPECT_LE(imbalance(c.problem, again), 1e-12);
}

// A moved contact does not press at its old place any more.
TEST(ReSolve, BalancesContactsThatMovedOrOpen) {
  Solved c;
  ASSERT_LE(imbalance(c.problem, c.solution), 1e-12);
  c.problem.contacts[0].arm_A.x() += 0.2;
  c.problem.contacts[0].arm_B.x() += 0.2;
  c.problem.contacts[5].least_normal_velocity = -10.0;
  c.problem.contacts[6].frame.row(0).swap(c.problem.contacts[6].frame.row(1));
  c.problem.contacts[6].frame.row(2) *= -1.0;
  const ContactSolution again =
      re_solve(c.problem, c.solution, {0, 5, 6}, {.tolerance = 1e-9, .sweeps = 10000});
  EXPECT_EQ(again.impulses[5], Vector3d::Zero());
  EXPECT_LE(imbalance(c.problem, again), 1e-12);
  EXPECT_LE(again.residual, 1e-7);
}

TEST(ReSolve, TakesNewContactsAndBodies) {
  Solved c;
  c.problem.bodies.emplace_back();  // Around the island, and coming.
  c.problem.bodies.back().v = {0.05, 0.0, 0.0};
  ContactPoint contact;
  contact.bodies = {c.problem.bodies.size() - 1, kLevels};  // Pushes the top of the first stack.
  contact.arm_B = {-0.5, 0.1, 0.2};
  contact.frame << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  contact.friction = 0.3;
  c.problem.contacts.push_back(contact);
  const ContactSolution again = re_solve(c.problem, c.solution, {c.problem.contacts.size() - 1},
                                         {.tolerance = 1e-9, .sweeps = 10000});
  EXPECT_LE(again.residual, 1e-7);
  EXPECT_GT(again.bodies[kLevels].v.x(), 0.03);
  EXPECT_EQ(again.impulses.size(), c.problem.contacts.size());
}

TEST(ReSolve, StopsAfterSoManySweeps) {
  Solved c;
  c.problem.contacts[0].least_normal_velocity = 0.05;
  const auto residual = [&](int sweeps) {
    return re_solve(c.problem, c.solution, {0}, {.tolerance = 1e-300, .sweeps = sweeps}).residual;
  };
  EXPECT_GT(residual(1), 1e-3);  // One sweep hands it on to the contacts beside.
  EXPECT_LT(residual(3), 0.05);  // As it was at first.
  EXPECT_LT(residual(100), 0.1 * residual(1));
}

}  // namespace
}  // namespace firstcontact::detail
