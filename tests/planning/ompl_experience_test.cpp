// Planners of OMPL that repair a path of an earlier scene: the repaired path is proven again.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/experience/LightningRetrieveRepair.h>
#include <ompl/geometric/planners/experience/ThunderRetrieveRepair.h>
#include <ompl/tools/lightning/LightningDB.h>
#include <ompl/tools/thunder/SPARSdb.h>
#include <ompl/tools/thunder/ThunderDB.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A gantry with an experience of an empty scene, in which a wall with a window appears.
class OmplExperience : public ::testing::Test {
 protected:
  /// A path through a place in the plane of the wall.
  og::PathGeometric old_path(const Configuration& middle) const {
    og::PathGeometric path(proven.si);
    for (const double x : {-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5}) {
      const double share = 1.0 - std::abs(x) / 1.5;
      ob::State* state =
          proven.state({x, 1.15 + share * (middle[1] - 1.15), -0.8 + share * (middle[2] + 0.8)});
      path.append(state);
      proven.si->freeState(state);
    }
    return path;
  }

  void set_wall() {
    proven.edges = std::make_shared<EdgeChecker>(with_gantry(thin_wall(0.5)));
    proven.validator = std::make_shared<ProvenEdges>(proven.si, proven.edges);
    proven.si->setStateValidityChecker(std::make_shared<ProvenStates>(proven.si, proven.edges));
    proven.si->setMotionValidator(proven.validator);
    proven.si->setup();
  }

  void expect_repaired_path(ob::Planner& planner) const {
    const og::PathGeometricPtr path = solve(planner, problem_between(proven, start, goal));
    ASSERT_NE(path, nullptr);
    EXPECT_EQ(unproven_edge(proven, *path), std::nullopt);
  }

  const Configuration start = {-1.5, 1.2, -0.7};
  const Configuration goal = {1.5, 1.1, -0.9};
  Proven proven{with_gantry(RobotScene())};
};

TEST_F(OmplExperience, IsRepairedByLightning) {
  const auto known = std::make_shared<ompl::tools::LightningDB>(proven.space);
  og::PathGeometric old = old_path({0.0, 1.15, -0.8});
  double seconds = 0.0;
  known->addPath(old, seconds);
  set_wall();
  ASSERT_NE(unproven_edge(proven, old), std::nullopt);
  og::LightningRetrieveRepair planner(proven.si, known);
  expect_repaired_path(planner);
}

// A roadmap that the wall cuts recalls nothing, so Thunder has its experience behind the wall.
TEST_F(OmplExperience, IsRecalledByThunder) {
  set_wall();
  auto graph = std::make_shared<og::SPARSdb>(proven.si);
  graph->setProblemDefinition(problem_between(proven, start, goal));
  graph->setup();
  const auto known = std::make_shared<ompl::tools::ThunderDB>(proven.space);
  known->setSPARSdb(graph);
  og::PathGeometric old = old_path({0.0, 0.0, 0.0});
  ASSERT_EQ(unproven_edge(proven, old), std::nullopt);
  double seconds = 0.0;
  ASSERT_TRUE(known->addPath(old, seconds));
  og::ThunderRetrieveRepair planner(proven.si, known);
  expect_repaired_path(planner);
}

}  // namespace
}  // namespace firstcontact::test
