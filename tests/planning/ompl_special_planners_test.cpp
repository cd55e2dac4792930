// Planners of OMPL that need more than a space: other planners, a field, a task, a decomposition.
//
// QMP is not in OMPL 1.5, and XXLPlanarDecomposition is for arms in the plane.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/AnytimePathShortening.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/quotientspace/QRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/TSRRT.h>
#include <ompl/geometric/planners/rrt/VFRRT.h>
#include <ompl/geometric/planners/xxl/XXL.h>
#include <ompl/geometric/planners/xxl/XXLPositionDecomposition.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Numbers = ob::RealVectorStateSpace::StateType;

constexpr double kReach = 1.9;  // [m]  Tasks and cells are within this of the origin.

/// The gantry before a wall with a window of 1 m.
class OmplSpecial : public ::testing::Test {
 protected:
  /// Lets a planner look for a path, and proves the path again.
  ///
  /// @param threshold  at the goal; wide for planners that never come to it exactly
  void expect_proven_path(ob::Planner& planner, double threshold = 1e-6) {
    const og::PathGeometricPtr path =
        solve(planner, problem_between(proven, start, goal, threshold));
    ASSERT_NE(path, nullptr);
    EXPECT_GT(path->getStateCount(), 2u);
    EXPECT_EQ(unproven_edge(proven, *path), std::nullopt);
  }

  const Configuration start = {-1.5, 1.2, -0.7};
  const Configuration goal = {1.5, 1.1, -0.9};
  const Proven proven{with_gantry(thin_wall(0.5))};
};

TEST_F(OmplSpecial, AnytimePathShorteningGivesAProvenPath) {
  const auto planner =
      og::AnytimePathShortening::createPlanner<og::RRTConnect, og::RRT, og::EST>(proven.si);
  const ob::ProblemDefinitionPtr problem = problem_between(proven, start, goal);
  planner->setProblemDefinition(problem);
  planner->setup();
  // It shortens and joins paths for as long as it may: until it has asked 20,000 times more.
  std::atomic<int> asked = 0;
  const ob::PlannerTerminationCondition done(
      [&] { return problem->hasExactSolution() && ++asked > 20'000; });
  planner->solve(
      ob::plannerOrTerminationCondition(done, ob::timedPlannerTerminationCondition(30.0)));
  ASSERT_TRUE(problem->hasExactSolution());
  for (const ob::PlannerSolution& solution : problem->getSolutions()) {
    const auto path = std::dynamic_pointer_cast<og::PathGeometric>(solution.path_);
    ASSERT_NE(path, nullptr);
    EXPECT_EQ(unproven_edge(proven, *path), std::nullopt) << solution.plannerName_;
  }
}

// Its field has one direction for each number, so that it knows no turns.
TEST_F(OmplSpecial, VFRRTGivesAProvenPath) {
  const auto towards_the_window = [](const ob::State* state) -> Eigen::VectorXd {
    const double* at = state->as<Numbers>()->values;
    return Eigen::Vector3d(1.0, -0.3 * at[1], -0.3 * at[2]);
  };
  og::VFRRT planner(proven.si, towards_the_window, 0.7, 1.0, 100);
  expect_proven_path(planner, 0.4);
}

/// The task of x and y: z is drawn.
class TaskInThePlane : public og::TaskSpaceConfig {
 public:
  int getDimension() const override { return 2; }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> place) const override {
    const double* at = state->as<Numbers>()->values;
    place << at[0], at[1];
  }
  void sample(Eigen::Ref<Eigen::VectorXd> place) const override {
    for (Eigen::Index k = 0; k < 2; ++k) {
      place[k] = random_.uniformReal(-kReach, kReach);
    }
  }
  bool lift(const Eigen::Ref<Eigen::VectorXd>& place, const ob::State* /*seed*/,
            ob::State* state) const override {
    double* at = state->as<Numbers>()->values;
    at[0] = place[0];
    at[1] = place[1];
    at[2] = random_.uniformReal(-kReach, kReach);
    return true;
  }

 private:
  mutable ompl::RNG random_;
};

TEST_F(OmplSpecial, TSRRTGivesAProvenPath) {
  og::TSRRT planner(proven.si, std::make_shared<TaskInThePlane>());
  expect_proven_path(planner, 0.4);
}

/// Cells of 0.95 m.
class Cells : public og::XXLPositionDecomposition {
 public:
  Cells() : XXLPositionDecomposition(box(), {4, 4, 4}) {}

  using XXLPositionDecomposition::locateRegion;

  int numLayers() const override { return 1; }
  bool sampleFromRegion(int region, ob::State* state, const ob::State* /*seed*/) const override {
    std::vector<int> cell;
    ridToGridCell(region, cell);
    for (std::size_t k = 0; k < 3; ++k) {
      const double size = cellSizes_[k];
      const double low = bounds_.low[k] + size * cell[k];
      state->as<Numbers>()->values[k] = random_.uniformReal(low, low + size);
    }
    return true;
  }
  bool sampleFromRegion(int region, ob::State* state, const ob::State* seed,
                        int /*layer*/) const override {
    return sampleFromRegion(region, state, seed);
  }
  void project(const ob::State* state, std::vector<double>& place, int /*layer*/) const override {
    const double* at = state->as<Numbers>()->values;
    place.assign(at, at + 3);
  }
  void project(const ob::State* state, std::vector<int>& layers) const override {
    layers = {locateRegion(state)};
  }
  int locateRegion(const ob::State* state) const override {
    std::vector<double> place;
    project(state, place, 0);
    return coordToRegion(place);
  }

 private:
  static ob::RealVectorBounds box() {
    ob::RealVectorBounds bounds(3);
    bounds.setLow(-kReach);
    bounds.setHigh(kReach);
    return bounds;
  }

  mutable ompl::RNG random_;
};

TEST_F(OmplSpecial, XXLGivesAProvenPath) {
  og::XXL planner(proven.si, std::make_shared<Cells>());
  expect_proven_path(planner);
}

// The first level is x and y, where all is free; its trees guide those of the second.
TEST_F(OmplSpecial, QRRTGivesAProvenPath) {
  const auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  plane->setBounds(-2.0, 2.0);
  const auto above = std::make_shared<ob::SpaceInformation>(plane);
  above->setStateValidityChecker(std::make_shared<ob::AllValidStateValidityChecker>(above));
  above->setup();
  // Quotients are found for plain spaces alone, not for compounds.
  std::vector<ob::SpaceInformationPtr> levels = {above, proven.si};
  og::QRRT planner(levels);
  expect_proven_path(planner);
}

}  // namespace
}  // namespace firstcontact::test
