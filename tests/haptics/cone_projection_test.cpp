// The force loop's projection, against other ways to the same answer.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>

#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector3d random_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return {normal(rng), normal(rng), normal(rng)};
}

ToolFrames one_tool() {
  ToolFrames frames;
  frames.lengths = {0.05, 0.05};
  frames.p_WC = {Vector3d::Zero(), Vector3d::Zero()};
  return frames;
}

std::vector<HapticContact> random_contacts(std::mt19937& rng, int count, double friction) {
  std::uniform_real_distribution<double> way(0.0, 1e-3);
  std::vector<HapticContact> contacts;
  for (int k = 0; k < count; ++k) {
    HapticContact contact;
    contact.point = 0.05 * random_vector(rng).normalized();
    // About upwards, as on a bumpy floor: some motion is always allowed.
    contact.normal = (Vector3d::UnitZ() + 0.6 * random_vector(rng).normalized()).normalized();
    contact.way = way(rng);
    contact.friction = friction;
    contacts.push_back(contact);
  }
  return contacts;
}

ConeProjection projection_of(const std::vector<HapticContact>& contacts) {
  ConeProjection cone(6, contacts.size());
  for (const HapticContact& contact : contacts) {
    cone.add(cone_contact(contact, one_tool()));
  }
  return cone;
}

Coordinates random_displacement(std::mt19937& rng) {
  std::normal_distribution<double> normal(0.0, 1e-2);
  Coordinates x{};
  for (std::size_t k = 0; k < 6; ++k) {
    x[k] = normal(rng);
  }
  return x;
}

Vector6d as_vector(const Coordinates& x) { return Eigen::Map<const Vector6d>(x.data()); }

/// The nearest allowed displacement by trying every set of active contacts: no friction.
Vector6d by_enumeration(const std::vector<HapticContact>& contacts, const Vector6d& free) {
  const auto count = static_cast<int>(contacts.size());
  Eigen::MatrixXd rows(count, 6);
  Eigen::VectorXd least(count);
  for (int k = 0; k < count; ++k) {
    const ConeContact cone = cone_contact(contacts[static_cast<std::size_t>(k)], one_tool());
    rows.row(k) = as_vector(cone.rows[0]).transpose();
    least[k] = -cone.way;
  }
  std::optional<Vector6d> best;
  for (int mask = 0; mask < 1 << count; ++mask) {
    std::vector<int> active;
    for (int k = 0; k < count; ++k) {
      if ((mask >> k & 1) != 0) {
        active.push_back(k);
      }
    }
    Vector6d x = free;
    if (!active.empty()) {
      const Eigen::MatrixXd A = rows(active, Eigen::all);
      const Eigen::VectorXd b = least(active) - A * free;
      x += A.transpose() * (A * A.transpose()).completeOrthogonalDecomposition().solve(b);
    }
    const bool is_allowed = (rows * x - least).minCoeff() >= -1e-10;
    if (is_allowed && (!best || (x - free).norm() < (*best - free).norm())) {
      best = x;
    }
  }
  return best.value();
}

TEST(ConeProjection, WithoutFrictionIsTheNearestOfAllActiveSets) {
  std::mt19937 rng(7);
  for (int i = 0; i < test::rounds(300, 60); ++i) {
    const auto contacts = random_contacts(rng, 1 + i % 8, 0.0);
    ConeProjection cone = projection_of(contacts);
    const Coordinates free = random_displacement(rng);
    const ConeProjectionResult found = cone.project(free, 1e-12, 64);
    ASSERT_TRUE(found.is_solved) << i;
    ASSERT_LT((as_vector(found.x) - by_enumeration(contacts, as_vector(free))).norm(), 1e-9) << i;
  }
}

/// How far a displacement and its impulses are from the laws of friction, by the other solver's
/// measure.
double residual_of(const std::vector<HapticContact>& contacts, const Coordinates& free,
                   const ConeProjection& cone, const Coordinates& x) {
  const ToolFrames frames = one_tool();
  ContactProblem problem;
  problem.bodies.resize(2);
  problem.bodies[1].inverse_inertia.mass = Vector3d::Ones();
  problem.bodies[1].inverse_inertia.rotation =
      Eigen::Matrix3d::Identity() / (frames.lengths[0] * frames.lengths[0]);
  problem.bodies[1].v = as_vector(free).head<3>();
  problem.bodies[1].w = as_vector(free).tail<3>() / frames.lengths[0];
  ContactSolution solution;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    ContactPoint point;
    point.bodies = {0, 1};
    point.arm_B = contacts[c].point;
    point.frame = contact_axes(contacts[c].normal);
    point.friction = contacts[c].friction;
    point.least_normal_velocity = -contacts[c].way;
    problem.contacts.push_back(point);
    const std::array<double, 3> r = cone.impulse(c);
    solution.impulses.emplace_back(r[0], r[1], r[2]);
  }
  solution.bodies = problem.bodies;
  solution.bodies[1].v = as_vector(x).head<3>();
  solution.bodies[1].w = as_vector(x).tail<3>() / frames.lengths[0];
  return contact_residual(problem, solution);
}

TEST(ConeProjection, KeepsCoulombsLawAsTheContactSolverMeasuresIt) {
  std::mt19937 rng(8);
  int solved = 0;
  constexpr int kCases = 400;
  for (int i = 0; i < kCases; ++i) {
    const auto contacts = random_contacts(rng, 1 + i % 12, 0.1 + 0.05 * (i % 9));
    ConeProjection cone = projection_of(contacts);
    const Coordinates free = random_displacement(rng);
    ConeProjectionResult found;
    for (int tick = 0; tick < 4; ++tick) {  // It goes on where the last one ended.
      found = cone.project(free, 1e-12, 200);
    }
    solved += found.is_solved && residual_of(contacts, free, cone, found.x) < 1e-6 ? 1 : 0;
  }
  EXPECT_GE(solved, kCases * 98 / 100);
}

// However early the work ends, each impulse is in its cone.
TEST(ConeProjection, GivesImpulsesInTheRoundConeWhereverTheWorkEnds) {
  std::mt19937 rng(9);
  for (int i = 0; i < 300; ++i) {
    const auto contacts = random_contacts(rng, 12, 0.4);
    ConeProjection cone = projection_of(contacts);
    const ConeProjectionResult found = cone.project(random_displacement(rng), 1e-9, 1 + i % 20);
    ASSERT_LE(found.pivots, 20 + 1);
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const std::array<double, 3> r = cone.impulse(c);
      ASSERT_GE(r[0], 0.0);
      ASSERT_LE(std::hypot(r[1], r[2]), 0.4 * r[0] * (1.0 + 1e-12)) << i;
    }
  }
}

TEST(ConeProjection, GivesExactlyNothingWhereNoContactPresses) {
  std::mt19937 rng(10);
  auto contacts = random_contacts(rng, 20, 0.5);
  for (HapticContact& contact : contacts) {
    contact.normal = Vector3d::UnitZ();
  }
  ConeProjection cone = projection_of(contacts);
  const Coordinates up{0.3, 0.1, 2.0};
  const ConeProjectionResult found = cone.project(up, 1e-9, 64);
  EXPECT_EQ(found.pressing, 0);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(found.force[k], 0.0);
    EXPECT_EQ(found.x[k], up[k]);
  }
}

// A point on a slope: within the cone it stays, beyond it slides down and not up.
TEST(ConeProjection, SticksWithinTheAngleOfFrictionAndSlidesBeyond) {
  HapticContact contact;
  contact.friction = 0.5;
  for (const double angle : {0.1, 0.4, 0.46, 0.47, 0.8}) {
    ConeProjection cone = projection_of({contact});
    const Coordinates pull{std::sin(angle), 0.0, -std::cos(angle)};
    ConeProjectionResult found;
    for (int tick = 0; tick < 5; ++tick) {
      found = cone.project(pull, 1e-12, 100);
    }
    EXPECT_NEAR(found.x[2], 0.0, 1e-10) << angle;
    if (std::tan(angle) < 0.5) {
      EXPECT_NEAR(found.x[0], 0.0, 1e-10) << angle;
    } else {
      EXPECT_NEAR(found.x[0], std::sin(angle) - 0.5 * std::cos(angle), 1e-10) << angle;
    }
  }
}

TEST(ConeProjection, EndsWhereContactsContradictEachOther) {
  HapticContact up;
  up.way = 0.0;
  HapticContact down = up;
  down.normal = -Vector3d::UnitZ();
  ConeProjection cone(6, 2);
  cone.add(cone_contact(up, one_tool()));
  ConeContact pushed = cone_contact(down, one_tool());
  pushed.shift[0] = 1.0;  // The ceiling comes down by a metre.
  cone.add(pushed);
  const ConeProjectionResult found = cone.project({0.0, 0.0, 0.1}, 1e-9, 64);
  EXPECT_FALSE(found.is_solved);
  for (const double f : found.force) {
    EXPECT_TRUE(std::isfinite(f));
  }
}

}  // namespace
}  // namespace firstcontact::detail
