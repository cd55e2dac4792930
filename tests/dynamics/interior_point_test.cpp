// The interior point against contact space, on walls of bricks.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Bricks 2 m wide, 1 m high and deep and of 1 kg, each on two of the row below, the lowest on the
/// ground (body 0); with random velocities and 0.1 m/s downwards.
ContactProblem wall(std::mt19937& rng, int rows, int columns, double friction,
                    double speed = 0.02) {
  std::normal_distribution<double> normal(0.0, speed);
  ContactProblem problem;
  problem.bodies.resize(1);
  const auto touch = [&](std::size_t below, std::size_t above, double x_below, double x_above) {
    for (const double y : {-0.5, 0.5}) {
      ContactPoint contact;
      contact.bodies = {below, above};
      contact.arm_A = {x_below, y, 0.5};
      contact.arm_B = {x_above, y, -0.5};
      contact.frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      contact.friction = friction;
      problem.contacts.push_back(contact);
    }
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      ContactBody brick;
      brick.inverse_inertia.mass.setOnes();
      brick.inverse_inertia.rotation = Vector3d(6.0, 2.4, 2.4).asDiagonal();
      brick.v = {normal(rng), normal(rng), -0.1 + normal(rng)};
      brick.w = {normal(rng), normal(rng), normal(rng)};
      problem.bodies.push_back(brick);
      const auto above = problem.bodies.size() - 1;
      if (row == 0) {
        touch(0, above, -1.0, -1.0);
        touch(0, above, 1.0, 1.0);
        continue;
      }
      // Every other row is shifted by half a brick to the right.
      const int right = row % 2 == 1 ? column + 1 : column;
      for (const int below : {right - 1, right}) {
        if (below < 0 || below >= columns) {
          continue;
        }
        const auto place = static_cast<std::size_t>(1 + (row - 1) * columns + below);
        const double sign = below == right ? 1.0 : -1.0;
        touch(place, above, -sign, 0.0);
        touch(place, above, 0.0, sign);
      }
    }
  }
  return problem;
}

detail::Projection nothing(const ContactProblem& problem, const detail::ContactRows& rows) {
  detail::Projection projection;
  projection.impulses.contacts.assign(problem.contacts.size(), Vector3d::Zero());
  projection.velocities = detail::velocities_after(rows, projection.impulses);
  projection.residual = detail::greatest_residual(rows, projection.impulses, projection.velocities);
  return projection;
}

TEST(InteriorPoint, IsTheSameAsContactSpaceWithoutFriction) {
  std::mt19937 rng(1);
  const ContactProblem problem = wall(rng, 6, 6, 0.0);
  const detail::ContactRows rows(problem);
  detail::Projection inner = nothing(problem, rows);
  detail::project_by_interior_point(problem, rows, {.tolerance = 1e-7}, inner);
  EXPECT_LE(inner.residual, 1e-7);
  detail::Projection swept = nothing(problem, rows);
  detail::project_in_contact_space(rows, {.tolerance = 1e-8, .sweeps = 100000}, swept);
  ASSERT_LE(swept.residual, 1e-8);
  EXPECT_TRUE(inner.velocities.allFinite());
  EXPECT_TRUE(swept.velocities.allFinite());
  EXPECT_LE((inner.velocities - swept.velocities).lpNorm<Eigen::Infinity>(), 1e-5);
}

TEST(InteriorPoint, MeetsTheLawsOfWallsInFewSteps) {
  std::mt19937 rng(2);
  for (const double friction : {0.1, 0.4, 0.8}) {
    for (const int rows : {4, 12}) {
      const ContactProblem problem = wall(rng, rows, 12, friction);
      const detail::ContactRows contact_rows(problem);
      detail::Projection projection = nothing(problem, contact_rows);
      const double before = projection.residual;
      detail::project_by_interior_point(problem, contact_rows, {.tolerance = 1e-4}, projection);
      EXPECT_LE(projection.residual, 1e-4) << friction << " " << rows << " from " << before;
      EXPECT_LE(projection.iterations, 60) << friction << " " << rows;
      for (const Vector3d& r : projection.impulses.contacts) {
        ASSERT_LE(r.tail<2>().norm(), friction * r[0] * (1.0 + 1e-12));
      }
    }
  }
}

// Sliding is what makes the laws one problem no longer convex. Rounds bring it nearer to them.
TEST(InteriorPoint, SlidingWallsConvergeInRounds) {
  std::mt19937 rng(4);
  for (const double friction : {0.2, 0.5}) {
    const ContactProblem problem = wall(rng, 12, 12, friction, 0.5);
    const detail::ContactRows rows(problem);
    detail::Projection few = nothing(problem, rows);
    const double before = few.residual;
    detail::project_by_interior_point(problem, rows, {.tolerance = 1e-4, .rounds = 2}, few);
    EXPECT_LE(few.residual, 0.02 * before) << friction;
    detail::Projection many = nothing(problem, rows);
    detail::project_by_interior_point(problem, rows, {.tolerance = 1e-4, .rounds = 30}, many);
    EXPECT_LE(many.residual, few.residual) << friction;
    EXPECT_NEAR(many.residual, detail::greatest_residual(rows, many.impulses, many.velocities),
                1e-12);
  }
}

// What many contacts are given to, and what it may leave.
// Sweeps that left little enough are the answer; else it is found from inside.
TEST(ProjectOnContacts, LeavesWhatIsEnough) {
  std::mt19937 rng(9);
  const ContactProblem problem = wall(rng, 10, 10, 0.5);
  const ProjectionOptions exact{.tolerance = 1e-4, .sweeps = 20, .rounds = 2};
  ProjectionOptions rough = exact;
  rough.enough = 0.1;
  const ContactSolution left = project_on_contacts(problem, rough);
  EXPECT_EQ(left.space, ProjectionSpace::contact);
  EXPECT_GT(left.residual, exact.tolerance);
  EXPECT_LE(left.residual, rough.enough);
  const ContactSolution found = project_on_contacts(problem, exact);
  EXPECT_EQ(found.space, ProjectionSpace::motion);
  EXPECT_LT(found.residual, left.residual);
}

TEST(ProjectOnContacts, SolvesWallsInMotionSpace) {
  std::mt19937 rng(3);
  const ContactProblem problem = wall(rng, 10, 12, 0.5);
  const ContactSolution solution = project_on_contacts(problem, {.tolerance = 1e-6});
  EXPECT_EQ(solution.space, ProjectionSpace::motion);
  EXPECT_LE(solution.residual, 5e-5);
  EXPECT_NEAR(contact_residual(problem, solution), solution.residual, 1e-9);
}

}  // namespace
}  // namespace firstcontact
