// Robots with a floating joint in OMPL: an SE3StateSpace behind the spaces of the other joints.

#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "firstcontact_ompl/proven_edges.h"
#include "planning/plan_cases.h"
#include "support/random.h"

namespace firstcontact {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A bar that floats, with an arm that swings, before a wall of 10 um with a window of 0.5 m.
PlanScene drone_before_a_window() {
  RobotDescription robot{.name = "drone", .links = {{"world"}, {"hull"}, {"arm"}}, .joints = {}};
  robot.links[1].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_box({0.6, 0.1, 0.1})});
  robot.links[2].collision.push_back({.name = "",
                                      .X_LG = {{0.1, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                                      .source = SphereGeometry{},
                                      .shape = make_box({0.2, 0.05, 0.05})});
  robot.joints.push_back(
      {.name = "base", .type = JointType::floating, .parent = "world", .child = "hull"});
  robot.joints.push_back({.name = "elbow",
                          .type = JointType::revolute,
                          .parent = "hull",
                          .child = "arm",
                          .X_PJ = {{0.32, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                          .axis = Eigen::Vector3d::UnitZ(),
                          .limits = {.lower = -1.5, .upper = 1.5}});
  const RobotModel model(robot);
  const std::map<std::string, JointMotion> held{{"base", Motion::fixed({{-1, 0, 0}, {1, 0, 0, 0}})},
                                                {"elbow", CoordinatePath::constant(0.0)}};
  const std::vector<std::string> names{"base", "elbow"};
  ConfigurationSpace space = ConfigurationSpace::of_joints(model, names, held);
  for (const char* axis : {"base/trans_x", "base/trans_y", "base/trans_z"}) {
    space.set_limits(axis, -1.2, 1.2);
  }
  RobotScene scene = test::thin_wall(0.25);
  const std::size_t number = scene.add_robot("drone", RobotMotion(model, held));
  return {.scene = std::move(scene), .robots = {number}, .space = std::move(space)};
}

class OmplFloating : public ::testing::Test {
 protected:
  OmplFloating() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);
    si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges));
    si->setMotionValidator(std::make_shared<ProvenEdges>(si, edges));
    si->setup();
  }

  ob::ScopedState<> at(const Configuration& q) const {
    ob::ScopedState<> state(space);
    states.write(q, state.get());
    return state;
  }

  std::shared_ptr<EdgeChecker> edges = std::make_shared<EdgeChecker>(drone_before_a_window());
  ob::StateSpacePtr space = make_ompl_space(edges->space());
  ob::SpaceInformationPtr si = std::make_shared<ob::SpaceInformation>(space);
  OmplStates states{*space, edges->space()};
};

TEST_F(OmplFloating, HasItsPoseBehindItsJoints) {
  const auto* compound = dynamic_cast<const ob::CompoundStateSpace*>(space.get());
  ASSERT_NE(compound, nullptr);
  ASSERT_EQ(compound->getSubspaceCount(), 2u);
  const auto* pose = dynamic_cast<const ob::SE3StateSpace*>(compound->getSubspace(1).get());
  ASSERT_NE(pose, nullptr);
  EXPECT_EQ(pose->getBounds().low, (std::vector<double>(3, -1.2)));
  const Configuration q = {0.5, 0.1, 0.2, 0.3, 0.5, -0.5, 0.5, 0.5};
  EXPECT_EQ(states.read(at(q).get()), q);
}

TEST_F(OmplFloating, InterpolatesAlongTheProvenEdge) {
  test::Random random(3);
  ob::ScopedState<> from(space);
  ob::ScopedState<> to(space);
  ob::ScopedState<> between(space);
  for (int k = 0; k < 2'000; ++k) {
    from.random();
    to.random();
    const double share = random.uniform(0.0, 1.0);
    space->interpolate(from.get(), to.get(), share, between.get());
    const Configuration got = states.read(between.get());
    const Configuration expected =
        edges->space().interpolate(states.read(from.get()), states.read(to.get()), share);
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_NEAR(got[c], expected[c], 1e-14);
    }
    double dot = 0.0;
    for (std::size_t c = 4; c < 8; ++c) {
      dot += got[c] * expected[c];
    }
    EXPECT_NEAR(std::abs(dot), 1.0, 1e-12);
  }
}

template <class Planner>
void expect_proven_path(const ob::SpaceInformationPtr& si, const EdgeChecker& edges,
                        const ob::ScopedState<>& start, const ob::ScopedState<>& goal,
                        const OmplStates& states) {
  auto problem = std::make_shared<ob::ProblemDefinition>(si);
  problem->setStartAndGoalStates(start, goal, 1e-6);
  Planner planner(si);
  planner.setProblemDefinition(problem);
  planner.setup();
  const ob::PlannerTerminationCondition found([&] { return problem->hasExactSolution(); });
  planner.solve(ob::plannerOrTerminationCondition(found, ob::timedPlannerTerminationCondition(30)));
  ASSERT_TRUE(problem->hasExactSolution());
  const auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
  const EdgeChecker strict(edges.scene(), {.tolerance = 1e-10, .extra_clearance = 0.0});
  for (unsigned int k = 0; k + 1 < path->getStateCount(); ++k) {
    EXPECT_EQ(
        strict.check(states.read(path->getState(k)), states.read(path->getState(k + 1))).verdict,
        EdgeVerdict::free);
  }
}

TEST_F(OmplFloating, PlannersLeadItThroughTheWindow) {
  const ob::ScopedState<> start = at({0.0, -0.8, 0.2, 0.1, 1, 0, 0, 0});
  const ob::ScopedState<> goal = at({0.4, 0.8, -0.2, 0.1, 0.8, 0, 0, 0.6});
  expect_proven_path<og::RRTConnect>(si, *edges, start, goal, states);
  expect_proven_path<og::PRM>(si, *edges, start, goal, states);
}

// Half a turn has two shortest ways, of which OMPL may take the other one.
TEST_F(OmplFloating, RefusesHalfATurn) {
  EXPECT_FALSE(si->checkMotion(at({0, -0.8, 0, 0, 1, 0, 0, 0}).get(),
                               at({0, -0.8, 0, 0, 0, 1, 0, 0}).get()));
  EXPECT_TRUE(si->checkMotion(at({0, -0.8, 0, 0, 1, 0, 0, 0}).get(),
                              at({0, -0.8, 0, 0, 0.6, 0.8, 0, 0}).get()));
}

TEST_F(OmplFloating, RefusesOtherOrdersAndSpaces) {
  const auto arm = std::make_shared<ob::RealVectorStateSpace>(1);
  arm->setBounds(-1.5, 1.5);
  const auto pose = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds bounds(3);
  bounds.setLow(-1.2);
  bounds.setHigh(1.2);
  pose->setBounds(bounds);
  const auto compound = [](const ob::StateSpacePtr& a, const ob::StateSpacePtr& b) {
    auto both = std::make_shared<ob::CompoundStateSpace>();
    both->addSubspace(a, 2.0);
    both->addSubspace(b, 1.0);
    return both;
  };
  EXPECT_NO_THROW(OmplStates(*compound(arm, pose), edges->space()));
  EXPECT_THROW(OmplStates(*compound(pose, arm), edges->space()), std::invalid_argument);
  EXPECT_THROW(OmplStates(*pose, edges->space()), std::invalid_argument);
  const auto numbers = std::make_shared<ob::RealVectorStateSpace>(8);
  numbers->setBounds(-1.5, 1.5);
  EXPECT_THROW(OmplStates(*numbers, edges->space()), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
