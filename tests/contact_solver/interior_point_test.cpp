// The interior point against contact space, on walls of bricks.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/interior_point.h>
#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>

#include "contact_solver/wall_problem.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::nothing;
using test::wall;
using test::wall_with_heavy_top;

TEST(InteriorPoint, IsTheSameAsGaussSeidelWithoutFriction) {
  std::mt19937 rng(1);
  const ContactProblem problem = wall(rng, 6, 6, 0.0);
  const detail::ContactRows rows(problem);
  detail::Projection inner = nothing(problem, rows);
  detail::project_by_interior_point(problem, rows, {.tolerance = 1e-7}, inner);
  EXPECT_LE(inner.residual, 1e-7);
  detail::Projection swept = nothing(problem, rows);
  detail::project_by_gauss_seidel(problem, rows, {.tolerance = 1e-8, .sweeps = 100000}, swept);
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

// Light bricks that bear heavy ones: impulses have to grow by as much as these are heavier.
TEST(InteriorPoint, TakesFewStepsWhereMassesDiffer) {
  for (const double heavier : {1e2, 1e4, 1e6}) {
    std::mt19937 rng(1);
    const ContactProblem problem = wall_with_heavy_top(rng, 40, 0.0, heavier);
    const detail::ContactRows rows(problem);
    detail::Projection projection = nothing(problem, rows);
    detail::project_by_interior_point(problem, rows, {.tolerance = 1e-4}, projection);
    EXPECT_LE(projection.residual, 1e-4) << heavier;
    EXPECT_LE(projection.iterations, 20) << heavier;
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

// The solver of many contacts, and the residual that it may leave. Sweeps that leave a small enough
// residual are the answer; else the interior point method finds it.
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

TEST(ProjectOnContacts, SolvesWallsByAugmentedLagrangian) {
  std::mt19937 rng(3);
  const ContactProblem problem = wall(rng, 10, 12, 0.5);
  const ContactSolution solution = project_on_contacts(problem, {.tolerance = 1e-6});
  EXPECT_EQ(solution.space, ProjectionSpace::motion);
  EXPECT_LE(solution.residual, 5e-5);
  EXPECT_NEAR(contact_residual(problem, solution), solution.residual, 1e-9);
}

}  // namespace
}  // namespace firstcontact
