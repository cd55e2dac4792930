// Contacts eight or sixteen at a time against one by one, on each instruction set.

#include <array>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_batches.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

#include "contact_solver/wall_problem.h"
#include "support/instruction_sets.h"
#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::nothing;
using test::wall;

/// A wall of which one brick moves along one axis only, one is driven by a script, and one touches
/// what nothing moves.
ContactProblem odd_wall(std::mt19937& rng, double friction, double speed = 0.3) {
  ContactProblem problem = wall(rng, 8, 12, friction, speed);
  problem.bodies[40].inverse_inertia.rotation.setZero();
  problem.bodies[40].inverse_inertia.mass.head<2>().setZero();
  problem.bodies[50].inverse_inertia = {};
  ContactPoint stuck = problem.contacts[0];
  stuck.bodies = {0, 50};
  problem.contacts.push_back(stuck);
  return problem;
}

class ContactBatchesOn : public test::OnInstructionSet {
 protected:
  /// There and back, one by one: the order tells.
  static void sweep_rows(const ContactRows& rows, Projection& projection) {
    const std::size_t n = rows.contacts.size();
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const std::size_t k = i < n ? i : 2 * n - 1 - i;
      solve_alone(rows.contacts[k], projection.impulses.contacts[k], projection.velocities);
    }
  }
};

// Without friction both agree to the last digits. A sliding contact is solved by a few Newton steps
// in each sweep.
TEST_P(ContactBatchesOn, SweepAsRowsDoInTheirOrder) {
  std::mt19937 rng(1);
  for (const double friction : {0.0, 3.0}) {
    const ContactProblem problem = odd_wall(rng, friction, friction > 0.0 ? 1e-3 : 0.3);
    const ContactRows rows(problem);
    Projection one_by_one = nothing(problem, rows);
    Projection at_once = one_by_one;
    std::optional<ContactBatches<double>> batches = ContactBatches<double>::of(problem, rows);
    ASSERT_TRUE(batches);
    VectorXd state = batches->state_of(at_once);
    for (int k = 0; k < 3; ++k) {
      sweep_rows(rows, one_by_one);
      batches->sweep(false, state);
      batches->sweep(true, state);
    }
    batches->take(state, at_once);
    EXPECT_TRUE(at_once.velocities.allFinite());
    EXPECT_LE((at_once.velocities - one_by_one.velocities).lpNorm<Eigen::Infinity>(),
              friction > 0.0 ? 1e-6 : 1e-12);
    EXPECT_EQ(at_once.residual, greatest_residual(rows, at_once.impulses, at_once.velocities));
  }
}

TEST_P(ContactBatchesOn, GoOnFromImpulsesThatActAlready) {
  std::mt19937 rng(2);
  const ContactProblem problem = odd_wall(rng, 0.0);
  const ContactRows rows(problem);
  Projection one_by_one = nothing(problem, rows);
  sweep_rows(rows, one_by_one);
  std::optional<ContactBatches<double>> batches = ContactBatches<double>::of(problem, rows);
  ASSERT_TRUE(batches);
  Projection at_once = one_by_one;
  VectorXd state = batches->state_of(at_once);
  batches->take(state, at_once);
  ASSERT_EQ(at_once.impulses.contacts, one_by_one.impulses.contacts);
  sweep_rows(rows, one_by_one);
  batches->sweep(false, state);
  batches->sweep(true, state);
  batches->take(state, at_once);
  EXPECT_LE((at_once.velocities - one_by_one.velocities).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST_P(ContactBatchesOn, SlideOnTheConeAndConverge) {
  std::mt19937 rng(3);
  for (const double friction : {0.05, 0.3, 0.8}) {
    const ContactProblem problem = odd_wall(rng, friction);
    const ContactRows rows(problem);
    std::optional<ContactBatches<double>> batches = ContactBatches<double>::of(problem, rows);
    ASSERT_TRUE(batches);
    Projection at_once = nothing(problem, rows);
    VectorXd state = batches->state_of(at_once);
    Projection one_by_one = at_once;
    for (int k = 0; k < 200; ++k) {
      batches->sweep(false, state);
      batches->sweep(true, state);
      sweep_rows(rows, one_by_one);
    }
    batches->take(state, at_once);
    int sliding = 0;
    for (const Vector3d& r : at_once.impulses.contacts) {
      ASSERT_LE(r.tail<2>().norm(), friction * r[0] * (1.0 + 1e-12));
      sliding += r[0] > 0.0 && r.tail<2>().norm() >= friction * r[0] * (1.0 - 1e-12) ? 1 : 0;
    }
    EXPECT_GE(sliding, 10) << friction;
    const double others = greatest_residual(rows, one_by_one.impulses, one_by_one.velocities);
    EXPECT_LE(at_once.residual, 2.0 * others + 1e-10) << friction;
  }
}

/// The same problem where everything is so much heavier and faster.
ContactProblem scaled(ContactProblem problem, double mass, double speed) {
  for (ContactBody& body : problem.bodies) {
    body.inverse_inertia.mass /= mass;
    body.inverse_inertia.rotation /= mass;
    body.v *= speed;
    body.w *= speed;
  }
  for (ContactPoint& contact : problem.contacts) {
    contact.least_normal_velocity *= speed;
  }
  return problem;
}

// In single precision, whatever the units of the problem.
TEST_P(ContactBatchesOn, ConvergeInSinglePrecision) {
  constexpr std::array<std::pair<double, double>, 3> kScales = {
      {{1.0, 1.0}, {1e-12, 1e-6}, {1e12, 1e4}}};
  for (std::size_t scale = 0; scale < std::size_t{test::rounds(3, 1)}; ++scale) {
    const auto& [mass, speed] = kScales[scale];
    std::mt19937 rng(6);
    const ContactProblem problem = scaled(wall(rng, 2, 120, 0.4), mass, speed);
    const ContactRows rows(problem);
    const BatchUnits units = units_of(rows);
    auto batches = ContactBatches<float>::of(problem, rows, units);
    ASSERT_TRUE(batches);
    Projection at_once = nothing(problem, rows);
    auto state = batches->state_of(at_once);
    double change = 0.0;
    for (int k = 0; k < 800; ++k) {
      batches->sweep(false, state);
      change = batches->sweep(true, state);
    }
    EXPECT_LE(change, 1e-5 * speed);
    batches->take(state, at_once);
    EXPECT_LE(at_once.residual, 1e-5 * speed) << mass;
    EXPECT_GE(at_once.residual, 1e-12 * speed) << "not in single precision";
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      const Vector3d& r = at_once.impulses.contacts[k];
      ASSERT_LE(r.tail<2>().norm(), problem.contacts[k].friction * r[0] * (1.0 + 1e-12));
    }
  }
}

TEST_P(ContactBatchesOn, GoOnInSinglePrecisionFromImpulsesThatActAlready) {
  std::mt19937 rng(2);
  const ContactProblem problem = wall(rng, 2, 120, 0.4);
  const ContactRows rows(problem);
  Projection one_by_one = nothing(problem, rows);
  for (int k = 0; k < 800; ++k) {
    sweep_rows(rows, one_by_one);
  }
  auto batches = ContactBatches<float>::of(problem, rows, units_of(rows));
  ASSERT_TRUE(batches);
  Projection at_once = one_by_one;
  auto state = batches->state_of(at_once);
  EXPECT_LE(batches->sweep(false, state), 1e-5);
  batches->take(state, at_once);
  EXPECT_LE(at_once.residual, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, ContactBatchesOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

TEST(ContactBatches, AreNotForFewBodiesWithManyContacts) {
  std::mt19937 rng(4);
  ContactProblem problem = wall(rng, 1, 1, 0.5);
  const ContactPoint contact = problem.contacts[0];
  problem.contacts.resize(1000, contact);
  EXPECT_FALSE(ContactBatches<double>::of(problem, ContactRows(problem)));
  problem = wall(rng, 1, 3, 0.5);
  ASSERT_LT(problem.contacts.size(), 16);
  EXPECT_FALSE(ContactBatches<double>::of(problem, ContactRows(problem)));
}

}  // namespace
}  // namespace firstcontact::detail
