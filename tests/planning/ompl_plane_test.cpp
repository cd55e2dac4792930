#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
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

using Plane = ob::SE2StateSpace;

/// A bar of 0.6 m by 0.1 m in the plane, on one side of a wall with a gap of 0.2 m.
PlanScene bar_before_a_gap() {
  RobotScene scene;
  scene.add_body("left", make_box({1e-4, 1.9, 1.0}), test::resting_at({0.0, -1.05, 0.0}));
  scene.add_body("right", make_box({1e-4, 1.9, 1.0}), test::resting_at({0.0, 1.05, 0.0}));
  ConfigurationSpace space = ConfigurationSpace::of_body_in_plane("bar", make_box({0.1, 0.6, 0.1}),
                                                                  {-1.5, -1.5}, {1.5, 1.5});
  const Configuration origin = {0, 0, 0};
  const std::size_t robot = scene.add_robot("bar", space.motion(origin, origin));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

class OmplPlane : public ::testing::Test {
 protected:
  OmplPlane() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);
    si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges));
    si->setMotionValidator(std::make_shared<ProvenEdges>(si, edges));
    si->setup();
  }

  ob::ScopedState<Plane> at(double x, double y, double yaw) const {
    ob::ScopedState<Plane> state(space);
    state->setXY(x, y);
    state->setYaw(yaw);
    return state;
  }

  std::shared_ptr<EdgeChecker> edges = std::make_shared<EdgeChecker>(bar_before_a_gap());
  ob::StateSpacePtr space = make_ompl_space(edges->space());
  ob::SpaceInformationPtr si = std::make_shared<ob::SpaceInformation>(space);
  OmplStates states{*space, edges->space()};
};

TEST_F(OmplPlane, IsAnSE2StateSpaceWithTheRectangleAsBounds) {
  const auto* plane = dynamic_cast<const Plane*>(space.get());
  ASSERT_NE(plane, nullptr);
  EXPECT_EQ(plane->getBounds().low, (std::vector<double>{-1.5, -1.5}));
  EXPECT_EQ(plane->getBounds().high, (std::vector<double>{1.5, 1.5}));
}

// A state between two is a place of the edge that is proven, also across half a turn.
TEST_F(OmplPlane, InterpolatesAlongTheProvenEdge) {
  test::Random random(3);
  ob::ScopedState<Plane> between = at(0, 0, 0);
  for (int k = 0; k < 2'000; ++k) {
    ob::ScopedState<Plane> from =
        at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.14, 3.14));
    ob::ScopedState<Plane> to =
        at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.14, 3.14));
    const double share = random.uniform(0.0, 1.0);
    space->interpolate(from.get(), to.get(), share, between.get());
    const Configuration got = states.read(between.get());
    const Configuration expected =
        edges->space().interpolate(states.read(from.get()), states.read(to.get()), share);
    EXPECT_NEAR(got[0], expected[0], 1e-14);
    EXPECT_NEAR(got[1], expected[1], 1e-14);
    EXPECT_NEAR(std::remainder(got[2] - expected[2], 2.0 * std::numbers::pi), 0.0, 1e-14);
  }
}

// The closed form of the bar: half widths 0.05 and 0.3 m, and a gap from -0.1 to 0.1 m.
TEST_F(OmplPlane, ValidatesTheBarInTheGap) {
  EXPECT_TRUE(si->isValid(at(0.0, 0.0, 0.5 * std::numbers::pi).get()));
  EXPECT_FALSE(si->isValid(at(0.0, 0.0, 0.0).get()));
  EXPECT_TRUE(si->isValid(at(-0.051, 0.0, 0.0).get()));
  EXPECT_FALSE(si->isValid(at(-0.04, 0.0, 0.0).get()));
  const double turn = 0.5 * std::numbers::pi;
  EXPECT_TRUE(si->checkMotion(at(-1, 0, turn).get(), at(1, 0, turn).get()));
  EXPECT_FALSE(si->checkMotion(at(-1, 0.06, turn).get(), at(1, 0.06, turn).get()));
  EXPECT_FALSE(si->checkMotion(at(-1, 0, 0).get(), at(1, 0, 0).get()));
}

template <class Planner>
void expect_proven_path(const ob::SpaceInformationPtr& si, const EdgeChecker& edges,
                        const ob::ScopedState<Plane>& start, const ob::ScopedState<Plane>& goal,
                        const OmplStates& states) {
  auto problem = std::make_shared<ob::ProblemDefinition>(si);
  problem->setStartAndGoalStates(start, goal, 1e-6);
  Planner planner(si);
  planner.setProblemDefinition(problem);
  planner.setup();
  const ob::PlannerTerminationCondition found([&] { return problem->hasExactSolution(); });
  planner.solve(ob::plannerOrTerminationCondition(found, ob::timedPlannerTerminationCondition(20)));
  ASSERT_TRUE(problem->hasExactSolution());
  const auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
  path->interpolate();
  const EdgeChecker strict(edges.scene(), {.tolerance = 1e-10, .extra_clearance = 0.0});
  for (unsigned int k = 0; k + 1 < path->getStateCount(); ++k) {
    EXPECT_EQ(
        strict.check(states.read(path->getState(k)), states.read(path->getState(k + 1))).verdict,
        EdgeVerdict::free);
  }
}

TEST_F(OmplPlane, PlannersTurnTheBarThroughTheGap) {
  expect_proven_path<og::RRTConnect>(si, *edges, at(-1, 0.5, 0), at(1, -0.5, 3), states);
  expect_proven_path<og::PRM>(si, *edges, at(-1, 0.5, 0), at(1, -0.5, 3), states);
}

// Their states are those of the plane, but their edges are arcs.
TEST_F(OmplPlane, RefusesSpacesOfCars) {
  EXPECT_THROW(OmplStates(ob::DubinsStateSpace(), edges->space()), std::invalid_argument);
  EXPECT_THROW(OmplStates(ob::ReedsSheppStateSpace(), edges->space()), std::invalid_argument);
  EXPECT_NO_THROW(OmplStates(Plane(), edges->space()));
  const PlanScene gantry = test::with_gantry(RobotScene());
  EXPECT_THROW(OmplStates(Plane(), gantry.space), std::invalid_argument);
}

// An arm on a cart that turns: a compound of the plane and of the arm, with odd weights.
TEST(OmplCompound, TakesAPlaneBesideJointsWhateverTheirWeights) {
  RobotDescription robot{.name = "cart", .links = {{"floor"}, {"cart"}, {"arm"}}, .joints = {}};
  robot.links[2].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_box({0.8, 0.1, 0.1})});
  robot.joints.push_back({.name = "drive",
                          .type = JointType::planar,
                          .parent = "floor",
                          .child = "cart",
                          .axis = Eigen::Vector3d::UnitZ()});
  robot.joints.push_back({.name = "lift",
                          .type = JointType::prismatic,
                          .parent = "cart",
                          .child = "arm",
                          .axis = Eigen::Vector3d::UnitZ(),
                          .limits = {.lower = 0.0, .upper = 1.0}});
  const RobotModel model(robot);
  const auto rest = CoordinatePath::constant(0.0);
  const std::map<std::string, JointMotion> held{{"drive", PlanarPath{rest, rest, rest}},
                                                {"lift", rest}};
  const std::vector<std::string> names{"drive/x", "drive/y", "drive/theta", "lift"};
  RobotScene scene;
  scene.add_body("post", make_box({0.1, 0.1, 0.6}), test::resting_at({1.0, 0.0, 0.0}));
  const std::size_t number = scene.add_robot("cart", RobotMotion(model, held));
  const EdgeChecker edges({.scene = std::move(scene),
                           .robots = {number},
                           .space = ConfigurationSpace::of_joints(model, names, held)});
  test::Random random(5);
  for (const double weight : {1e-3, 1.0, 50.0}) {
    const auto lift = std::make_shared<ob::RealVectorStateSpace>(1);
    lift->setBounds(0.0, 1.0);
    const auto plane = std::make_shared<Plane>();
    ob::RealVectorBounds bounds(2);
    bounds.setLow(-2.0);
    bounds.setHigh(2.0);
    plane->setBounds(bounds);
    const auto space = std::make_shared<ob::CompoundStateSpace>();
    space->addSubspace(plane, weight);
    space->addSubspace(lift, 1.0 / weight);
    space->setup();
    const OmplStates states(*space, edges.space());
    ob::ScopedState<> from(space);
    ob::ScopedState<> to(space);
    ob::ScopedState<> between(space);
    for (int k = 0; k < 500; ++k) {
      from.random();
      to.random();
      const double share = random.uniform(0.0, 1.0);
      space->interpolate(from.get(), to.get(), share, between.get());
      const Configuration got = states.read(between.get());
      const Configuration expected =
          edges.space().interpolate(states.read(from.get()), states.read(to.get()), share);
      for (const std::size_t c : {0u, 1u, 3u}) {
        EXPECT_NEAR(got[c], expected[c], 1e-14);
      }
      EXPECT_NEAR(std::remainder(got[2] - expected[2], 2.0 * std::numbers::pi), 0.0, 1e-14);
    }
  }
}

}  // namespace
}  // namespace firstcontact
