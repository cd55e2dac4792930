// Planners of OMPL that need nothing but a space: every path is proven again, edge by edge.

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/ompl_planners.h"
#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// The end of each planner's search.
struct Patience {
  int questions = 0;     ///< Number of times that the planner may ask whether to go on.
  double seconds = 0.0;  ///< [s]
};

/// Runs all planners, and proves their paths; returns those that did not get to the goal.
std::vector<std::string> unsolved_after(const PlanScene& scene, const Configuration& start,
                                        const Configuration& goal, const Patience& patience) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl::RNG::setSeed(1);
  std::vector<std::string> unsolved;
  for (const auto& [name, make] : all_planners()) {
    const Proven proven(scene);
    const ob::ProblemDefinitionPtr problem = problem_between(proven, start, goal);
    const ob::PlannerPtr planner = make(proven.si);
    planner->setProblemDefinition(problem);
    planner->setup();
    std::atomic<int> asked = 0;
    const ob::PlannerTerminationCondition done(
        [&] { return problem->hasExactSolution() || ++asked > patience.questions; });
    planner->solve(ob::plannerOrTerminationCondition(
        done, ob::timedPlannerTerminationCondition(patience.seconds)));
    if (!problem->hasExactSolution()) {
      unsolved.push_back(name);
    }
    const auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
    if (path) {
      EXPECT_EQ(unproven_edge(proven, *path), std::nullopt) << name;
    }
  }
  return unsolved;
}

TEST(OmplPlanners, GiveProvenPathsOfJoints) {
  const std::vector<std::string> unsolved =
      unsolved_after(with_gantry(thin_wall(0.5)), {-1.5, 1.2, -0.7}, {1.5, 1.1, -0.9},
                     {.questions = 1'000'000'000, .seconds = 3.0});
  // Some need more time, or a rougher space, for their first path; most do not.
  EXPECT_LE(unsolved.size(), all_planners().size() / 3) << ::testing::PrintToString(unsolved);
}

// A sheet of 10 um is across the straight way, and most ways around it are free.
TEST(OmplPlanners, GiveProvenPathsOfABody) {
  RobotScene scene;
  scene.add_body("sheet", make_box({1e-5, 1.0, 1.0}));
  const std::vector<std::string> unsolved = unsolved_after(
      with_bar(std::move(scene), {0.05, 0.3, 0.05}), {-0.8, 0.1, 0.0, 1.0, 0.0, 0.0, 0.0},
      {0.8, -0.1, 0.0, 0.8, 0.0, 0.0, 0.6}, {.questions = 3'000, .seconds = 20.0});
  EXPECT_LE(unsolved.size(), all_planners().size() / 2) << ::testing::PrintToString(unsolved);
}

}  // namespace
}  // namespace firstcontact::test
