// Proven edges and places in OMPL: what is valid, and the last valid state.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "firstcontact_ompl/proven_edges.h"
#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

TEST(Ompl, GivesALastValidStateThatIsProven) {
  const PlanScene scene = with_gantry(thin_wall(0.3));
  const EdgeChecker strict(scene, {.tolerance = 1e-10, .extra_clearance = 0.0});
  const Proven proven(scene);
  const OmplStates states(*proven.space, proven.edges->space());
  Random random(1);
  int blocked = 0;
  for (int k = 0; k < 100; ++k) {
    ob::State* from = proven.state({-1.0, random.uniform(-1, 1), random.uniform(-1, 1)});
    ob::State* to = proven.state({1.0, random.uniform(-1, 1), random.uniform(-1, 1)});
    const Configuration end = states.read(to);
    // Null, and the end itself, are both allowed.
    std::pair<ob::State*, double> nowhere(nullptr, -1.0);
    const bool is_free = proven.validator->checkMotion(from, to, nowhere);
    std::pair<ob::State*, double> last(to, -1.0);
    ASSERT_EQ(proven.validator->checkMotion(from, to, last), is_free);
    ASSERT_EQ(proven.validator->checkMotion(from, proven.state(end)), is_free);
    if (is_free) {
      ASSERT_EQ(states.read(to), end);
      ASSERT_EQ(last.second, -1.0);
    } else {
      ++blocked;
      ASSERT_EQ(nowhere.second, last.second);
      ASSERT_EQ(strict.check(states.read(from), states.read(to)).verdict, EdgeVerdict::free) << k;
      ASSERT_NEAR(last.second, proven.edges->check(states.read(from), end).fraction, 1e-2);
    }
    proven.si->freeState(from);
    proven.si->freeState(to);
  }
  EXPECT_GT(blocked, 50);
}

/// Lets RRT-Connect lead a body through the window of a wall, and proves what it densifies.
template <class Space>
void expect_path_through_window(const PlanScene& scene, double turn) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const Proven proven(scene);
  const OmplStates states(*proven.space, proven.edges->space());
  auto problem = std::make_shared<ob::ProblemDefinition>(proven.si);
  ob::ScopedState<Space> start(proven.space);
  start->setXYZ(-0.8, 1.0, 0.0);
  start->rotation().setIdentity();
  ob::ScopedState<Space> goal(proven.space);
  goal->setXYZ(0.8, 1.0, 0.0);
  goal->rotation().setAxisAngle(0.0, 0.0, 1.0, turn);
  problem->setStartAndGoalStates(start, goal, 1e-6);
  og::RRTConnect planner(proven.si);
  planner.setProblemDefinition(problem);
  planner.setup();
  planner.solve(ob::timedPlannerTerminationCondition(10.0));
  ASSERT_TRUE(problem->hasExactSolution());
  const auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
  path->interpolate();
  const EdgeChecker strict(scene, {.tolerance = 1e-10, .extra_clearance = 0.0});
  for (std::size_t k = 0; k + 1 < path->getStateCount(); ++k) {
    EXPECT_EQ(strict
                  .check(states.read(path->getState(static_cast<unsigned int>(k))),
                         states.read(path->getState(static_cast<unsigned int>(k + 1))))
                  .verdict,
              EdgeVerdict::free);
  }
}

TEST(Ompl, PlansForABody) {
  expect_path_through_window<ob::SE3StateSpace>(with_bar(thin_wall(0.4), {0.05, 0.3, 0.05}), 0.5);
}

/// An edge of about half a turn about z: it ends at (w, 0, 0, z).
Configuration turned(double w, double z) { return {0, 0, 0, w, 0, 0, z}; }

// Sound: what is valid turns the same way in OMPL and in the proof.
TEST(Ompl, TurnsAsProvenNearHalfATurn) {
  const Proven proven(with_bar(RobotScene(), {0.1, 0.2, 0.3}));
  const OmplStates states(*proven.space, proven.edges->space());
  Random random(11);
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {
    Eigen::Vector4d start = Eigen::Vector4d::NullaryExpr([&] { return random.uniform(-1, 1); });
    Eigen::Vector4d end = Eigen::Vector4d::NullaryExpr([&] { return random.uniform(-1, 1); });
    start.normalize();
    end = (end - end.dot(start) * start).normalized();
    end += std::exp2(random.uniform(-58, -40)) * start;
    ob::State* from = proven.state({0, 0, 0, start[0], start[1], start[2], start[3]});
    ob::State* to = proven.state({0, 0, 0, end[0], end[1], end[2], end[3]});
    ob::State* quarter = proven.si->allocState();
    proven.space->interpolate(from, to, 0.25, quarter);
    const Configuration there = states.read(quarter);
    const Configuration ours =
        proven.edges->space().interpolate(states.read(from), states.read(to), 0.25);
    double dot = 0.0;
    for (std::size_t i = 3; i < 7; ++i) {
      dot += there[i] * ours[i];
    }
    if (proven.validator->checkMotion(from, to)) {
      ASSERT_NEAR(std::abs(dot), 1.0, 1e-12) << k;
    } else {
      ++refused;
    }
    for (ob::State* state : {from, to, quarter}) {
      proven.si->freeState(state);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(Ompl, RefusesHalfATurn) {
  const Proven proven(with_bar(RobotScene(), {0.1, 0.2, 0.3}));
  ob::State* from = proven.state(turned(1, 0));
  ob::State* half = proven.state(turned(0, -1));
  const unsigned int invalid = proven.validator->getInvalidMotionCount();
  EXPECT_FALSE(proven.validator->checkMotion(from, half));
  ob::State* reached = proven.si->allocState();
  std::pair<ob::State*, double> last(reached, -1.0);
  EXPECT_FALSE(proven.validator->checkMotion(from, half, last));
  EXPECT_EQ(proven.validator->getInvalidMotionCount(), invalid + 2);
  EXPECT_EQ(last.second, 0.0);
  EXPECT_TRUE(proven.space->equalStates(reached, from));
  // Tight: a picoradian less than half a turn is an edge.
  ob::State* nearly = proven.state(turned(1e-12, -1));
  EXPECT_TRUE(proven.validator->checkMotion(from, nearly));
  for (ob::State* state : {from, half, nearly, reached}) {
    proven.si->freeState(state);
  }
}

// OMPL leaves out a turn of 80 urad: the tip of a rod of 20 m, 0.8 mm lower in the end, meets a
// block on the way. Our edge turns all the time, and is free.
TEST(Ompl, RefusesATurnThatItLeavesOut) {
  constexpr double kHalf = 4e-5;  // [rad]  Half of the turn.
  RobotScene scene;
  scene.add_body("block", make_box({0.01, 0.01, 0.01}), resting_at({9.95, 0.1096, 0.0}));
  const Proven proven(with_bar(std::move(scene), {20.0, 0.01, 0.01}));
  const Configuration start = turned(1, 0);
  Configuration end = {0, 0.1, 0, std::cos(kHalf), 0, 0, -std::sin(kHalf)};
  EXPECT_EQ(proven.edges->check(start, end).verdict, EdgeVerdict::free);
  ob::State* from = proven.state(start);
  ob::State* to = proven.state(end);
  ob::State* between = proven.si->allocState();
  proven.space->interpolate(from, to, 0.999, between);
  EXPECT_FALSE(proven.si->isValid(between));
  EXPECT_FALSE(proven.validator->checkMotion(from, to));
  std::pair<ob::State*, double> last(between, -1.0);
  EXPECT_FALSE(proven.validator->checkMotion(from, to, last));
  EXPECT_EQ(last.second, 0.0);
  EXPECT_TRUE(proven.space->equalStates(between, from));
  // Without a turn, and with one that OMPL takes part in, the motion is as ours.
  for (const double half : {0.0, 1e-15, 1e-3}) {
    end = {0, 0.05, 0, std::cos(half), 0, 0, -std::sin(half)};
    ob::State* other = proven.state(end);
    EXPECT_TRUE(proven.validator->checkMotion(from, other)) << half;
    proven.si->freeState(other);
  }
  for (ob::State* state : {from, to, between}) {
    proven.si->freeState(state);
  }
}

// Quaternions have lengths that OMPL takes as 1. What is valid is turned by OMPL as by us; what is
// refused is less than 2e-4 rad.
TEST(Ompl, FollowsOrRefusesSmallTurns) {
  const Proven proven(with_bar(RobotScene(), {0.1, 0.2, 0.3}));
  const OmplStates states(*proven.space, proven.edges->space());
  Random random(12);
  int refused = 0;
  int left_out = 0;
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Quaterniond start = random.rotation();
    const double turn = random.logarithmic(1e-9, 1e-2);
    const Eigen::Quaterniond end =
        start * Eigen::Quaterniond(Eigen::AngleAxisd(turn, random.rotation().vec().normalized()));
    const auto place = [&](const Eigen::Quaterniond& q) {
      const double length = 1.0 + random.uniform(-9e-10, 9e-10);
      return Configuration{0, 0, 0, length * q.w(), length * q.x(), length * q.y(), length * q.z()};
    };
    ob::State* from = proven.state(place(start));
    ob::State* to = proven.state(place(end));
    ob::State* quarter = proven.si->allocState();
    ASSERT_TRUE(proven.space->satisfiesBounds(from) && proven.space->satisfiesBounds(to)) << k;
    proven.space->interpolate(from, to, 0.25, quarter);
    const Configuration q = states.read(quarter);
    const Eigen::Quaterniond there = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized();
    const double off = there.angularDistance(start.slerp(0.25, end));
    left_out += off > 0.1 * turn ? 1 : 0;
    if (proven.validator->checkMotion(from, to)) {
      ASSERT_LT(off, 2e-8) << k << ' ' << turn;
    } else {
      ++refused;
      ASSERT_LT(turn, 2e-4) << k;
    }
    for (ob::State* state : {from, to, quarter}) {
      proven.si->freeState(state);
    }
  }
  EXPECT_GT(left_out, 500);
  EXPECT_GE(refused, left_out);
}

/// A small cube among bodies, whose edges are screws.
PlanScene with_screws(RobotScene scene) {
  ConfigurationSpace space = ConfigurationSpace::of_body(
      "cube", make_box({0.1, 0.1, 0.1}), Eigen::Vector3d::Constant(-2.0),
      Eigen::Vector3d::Constant(2.0), BodyEdges::screw);
  const Configuration origin = {0, 0, 0, 1, 0, 0, 0};
  const std::size_t robot = scene.add_robot("cube", space.motion(origin, origin));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

/// A quarter of a turn about z through the origin takes the one to the other.
const Configuration kEast = {1, 0, 0, 1, 0, 0, 0};
const Configuration kNorth = {0, 1, 0, std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

TEST(Screws, AreEdgesOnAnArc) {
  const double on_arc = std::sqrt(0.5);
  RobotScene post;
  post.add_body("post", make_box({0.1, 0.1, 1.0}), resting_at({on_arc, on_arc, 0.0}));
  const EdgeChecker blocked(with_screws(std::move(post)));
  const EdgeAnswer answer = blocked.check(kEast, kNorth);
  EXPECT_EQ(answer.verdict, EdgeVerdict::blocked);
  EXPECT_GT(answer.fraction, 0.3);
  EXPECT_LT(answer.fraction, 0.5);
  EXPECT_EQ(
      blocked.check(kEast, blocked.space().interpolate(kEast, kNorth, answer.fraction)).verdict,
      EdgeVerdict::free);
  // The chord is 0.29 m away from the arc.
  RobotScene inside;
  inside.add_body("post", make_box({0.1, 0.1, 1.0}), resting_at({0.5, 0.5, 0.0}));
  EXPECT_EQ(EdgeChecker(with_screws(inside)).check(kEast, kNorth).verdict, EdgeVerdict::free);
  const PlanScene straight = with_bar(inside, {0.1, 0.1, 0.1});
  EXPECT_EQ(EdgeChecker(straight).check(kEast, kNorth).verdict, EdgeVerdict::blocked);
}

TEST(Screws, AreTheSameInOmplToTheBit) {
  const PlanScene scene = with_screws(RobotScene());
  const auto space = make_ompl_space(scene.space);
  const OmplStates states(*space, scene.space);
  const ob::StateSamplerPtr sampler = space->allocStateSampler();
  Random random(4);
  ob::State* from = space->allocState();
  ob::State* to = space->allocState();
  ob::State* between = space->allocState();
  for (int k = 0; k < 500; ++k) {
    sampler->sampleUniform(from);
    if (k % 5 == 0) {
      sampler->sampleUniformNear(to, from, 1e-7);  // Axes that are far away.
    } else {
      sampler->sampleUniform(to);
    }
    const double share = k % 7 == 0 ? 1.0 : random.uniform(0.0, 1.0);
    space->interpolate(from, to, share, between);
    EXPECT_EQ(states.read(between),
              scene.space.interpolate(states.read(from), states.read(to), share));
  }
  space->interpolate(from, to, 0.5, from);  // Into its own start.
  EXPECT_NE(states.read(from), states.read(to));
  for (ob::State* state : {from, to, between}) {
    space->freeState(state);
  }
}

TEST(Screws, AreNoStraightEdges) {
  const PlanScene screws = with_screws(RobotScene());
  const PlanScene straight = with_bar(RobotScene(), {1, 1, 1});
  EXPECT_THROW(OmplStates(ob::SE3StateSpace(), screws.space), std::invalid_argument);
  EXPECT_THROW(OmplStates(ScrewStateSpace(), straight.space), std::invalid_argument);
}

TEST(Screws, LeadAPlannerThroughAWindow) {
  expect_path_through_window<ScrewStateSpace>(with_screws(thin_wall(0.4)), 2.5);
}

TEST(Ompl, RefusesSpacesWhoseEdgesAreOthers) {
  const PlanScene bar = with_bar(RobotScene(), {1, 1, 1});
  EXPECT_THROW(OmplStates(ob::DubinsStateSpace(), bar.space), std::invalid_argument);
  EXPECT_THROW(OmplStates(ob::RealVectorStateSpace(7), bar.space), std::invalid_argument);
  const PlanScene arm = with_gantry(RobotScene());
  EXPECT_THROW(OmplStates(ob::SE3StateSpace(), arm.space), std::invalid_argument);
  EXPECT_THROW(OmplStates(ob::RealVectorStateSpace(2), arm.space), std::invalid_argument);
  EXPECT_THROW(OmplStates(ob::RealVectorStateSpace(4), arm.space), std::invalid_argument);
  EXPECT_THROW(OmplStates(ob::SO2StateSpace(), arm.space), std::invalid_argument);
  EXPECT_NO_THROW(OmplStates(ob::RealVectorStateSpace(3), arm.space));
}

TEST(Ompl, GivesAClearanceThatIsFinite) {
  const Proven proven(with_gantry(thin_wall(0.0)));
  ob::State* apart = proven.state({-0.5, 0.0, 0.0});
  ob::State* inside = proven.state({0.0, 0.0, 0.0});
  const ob::StateValidityCheckerPtr& checker = proven.si->getStateValidityChecker();
  EXPECT_LE(checker->clearance(apart), 0.399995);
  EXPECT_GE(checker->clearance(apart), 0.39998);
  EXPECT_EQ(checker->clearance(inside), 0.0);
  EXPECT_TRUE(checker->isValid(apart));
  EXPECT_FALSE(checker->isValid(inside));
  const Proven alone(with_gantry(RobotScene()));
  EXPECT_EQ(alone.si->getStateValidityChecker()->clearance(apart), ProvenStates::kFarthest);
  proven.si->freeState(apart);
  proven.si->freeState(inside);
}

}  // namespace
}  // namespace firstcontact::test
