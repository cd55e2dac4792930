// Inverse kinematics against closed forms and against forward kinematics of its own.

#include <firstcontact/edges/inverse_kinematics.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "robot/planar_arm.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kAnyTurn = 4.0;  // [rad]

std::map<std::string, JointMotion> at_zero(const RobotModel& model) {
  std::map<std::string, JointMotion> joints;
  for (const Joint& joint : model.joints()) {
    if (joint.type != JointType::fixed) {
      joints.emplace(joint.name, ramp(0.0, 0.0));
    }
  }
  return joints;
}

ConfigurationSpace space_of(const RobotModel& model) {
  std::vector<std::string> names;
  for (const Joint& joint : model.joints()) {
    names.push_back(joint.name);
  }
  return ConfigurationSpace::of_joints(model, names, at_zero(model));
}

/// Where the tip of an arm of two bars is to be.
LinkPoseGoal tip_at(double x, double y) {
  LinkPoseGoal goal{.link = 2, .rotation_tolerance = kAnyTurn};
  goal.X_LT.position.x() = 1.0;
  goal.X_WT.position = {x, y, 0.0};
  return goal;
}

TEST(ReachPose, FindsBothElbowsOfAPlanarArm) {
  const ConfigurationSpace space = space_of(planar_arm(2));
  const LinkPoseGoal goal = tip_at(1.0, 1.0);
  const std::vector<ReachedPose> places = reach_pose(space, goal, {0.1, 1.5});
  ASSERT_EQ(places.size(), 2u);
  const double right = 0.5 * std::numbers::pi;
  EXPECT_NEAR(std::remainder(places[0].q[0], 4.0 * right), 0.0, 1e-6);
  EXPECT_NEAR(std::remainder(places[0].q[1] - right, 4.0 * right), 0.0, 1e-6);
  EXPECT_NEAR(std::remainder(places[1].q[0] - right, 4.0 * right), 0.0, 1e-6);
  EXPECT_NEAR(std::remainder(places[1].q[1] + right, 4.0 * right), 0.0, 1e-6);
  EXPECT_TRUE(reaches(places[0], goal));
  EXPECT_LE(places[0].position_error, 1e-6);
}

// An arm in a plane has no third coordinate to turn its tip by.
TEST(ReachPose, TakesAPlaceWithinTheTolerancesWhereThePoseIsOutOfReach) {
  const ConfigurationSpace space = space_of(planar_arm(2));
  LinkPoseGoal turned = tip_at(std::cos(0.5) + std::cos(1.3), std::sin(0.5) + std::sin(1.3));
  for (const double tolerance : {0.5, 0.1, 0.01}) {
    turned.position_tolerance = 1e-4;
    turned.rotation_tolerance = tolerance;
    turned.X_WT.rotation = Eigen::AngleAxisd(1.3 + 0.6 * tolerance, Vector3d::UnitZ());
    const std::vector<ReachedPose> places = reach_pose(space, turned, {0.0, 0.1});
    ASSERT_FALSE(places.empty());
    EXPECT_TRUE(reaches(places[0], turned)) << tolerance << " " << places[0].rotation_error;
  }
  LinkPoseGoal far = tip_at(2.02, 0.0);
  EXPECT_FALSE(reaches(reach_pose(space, far, {0.0, 0.1}).at(0), far));
  far.position_tolerance = 0.05;
  EXPECT_TRUE(reaches(reach_pose(space, far, {0.0, 0.1}).at(0), far));
}

TEST(ReachPose, PassesOverPlacesThatWillNotDo) {
  const ConfigurationSpace space = space_of(planar_arm(2));
  const LinkPoseGoal goal = tip_at(1.0, 1.0);
  const auto bends_back = [](const Configuration& q) { return std::sin(q[1]) < 0.0; };
  const std::vector<ReachedPose> places =
      reach_pose(space, goal, {0.1, 1.5}, {.places = 1, .accepts = bends_back});
  ASSERT_EQ(places.size(), 1u);
  EXPECT_TRUE(reaches(places[0], goal) && bends_back(places[0].q));
  EXPECT_TRUE(
      reach_pose(space, goal, {0.1, 1.5}, {.accepts = [](const auto&) { return false; }}).empty());
}

TEST(ReachPose, TellsHowFarIsOutOfReach) {
  const ConfigurationSpace space = space_of(planar_arm(2));
  const LinkPoseGoal goal = tip_at(3.0, 4.0);
  const std::vector<ReachedPose> places = reach_pose(space, goal, {0.0, 0.1});
  ASSERT_EQ(places.size(), 1u);
  EXPECT_FALSE(reaches(places[0], goal));
  EXPECT_NEAR(places[0].position_error, 3.0, 1e-4);
}

/// Six hinges with axes in turn along z, y, y, x, y, x, each 0.3 m from the one before.
RobotModel wrist_arm(double limit) {
  const std::array<Vector3d, 6> axes{Vector3d::UnitZ(), Vector3d::UnitY(), Vector3d::UnitY(),
                                     Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitX()};
  RobotDescription arm{.name = "arm", .links = {{"base", {}, {}}}, .joints = {}};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    Joint joint{.name = "j" + std::to_string(k),
                .type = JointType::revolute,
                .parent = arm.links.back().name,
                .child = "l" + std::to_string(k)};
    joint.axis = axes[k];
    joint.X_PJ.position = {0.3, 0.02 * static_cast<double>(k), 0.0};
    joint.limits.lower = -limit;
    joint.limits.upper = 0.8 * limit;
    arm.links.push_back({joint.child, {}, {}});
    arm.joints.push_back(std::move(joint));
  }
  return RobotModel(arm);
}

/// The pose of the last link, by products of transforms.
Eigen::Isometry3d last_link(const RobotModel& model, const Configuration& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < q.size(); ++k) {
    const Joint& joint = model.joints()[k];
    X = X * Eigen::Translation3d(joint.X_PJ.position) * Eigen::AngleAxisd(q[k], joint.axis);
  }
  return X;
}

TEST(ReachPose, BringsALinkToRandomPosesWithinLimits) {
  const double limit = 2.0;
  const RobotModel model = wrist_arm(limit);
  const ConfigurationSpace space = space_of(model);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> angle(-limit, 0.8 * limit);
  int found = 0;
  for (int round = 0; round < 10; ++round) {
    Configuration wanted(6);
    for (double& q : wanted) {
      q = angle(rng);
    }
    const Eigen::Isometry3d X = last_link(model, wanted);
    LinkPoseGoal goal{.link = 6};
    goal.X_WT = {X.translation(), Eigen::Quaterniond(X.linear())};
    const std::vector<ReachedPose> places =
        reach_pose(space, goal, Configuration(6, 0.0), {.places = 3, .tries = 40});
    for (const ReachedPose& place : places) {
      EXPECT_FALSE(space.defect(place.q)) << *space.defect(place.q);
      const Eigen::Isometry3d there = last_link(model, place.q);
      EXPECT_LE((there.translation() - X.translation()).norm(), place.position_error + 1e-14);
      EXPECT_LE(Eigen::AngleAxisd(there.linear() * X.linear().transpose()).angle(),
                place.rotation_error + 1e-7);
    }
    found += reaches(places.front(), goal) ? 1 : 0;
  }
  EXPECT_GE(found, 9);
}

TEST(ReachPose, IsTheSameForASeed) {
  const ConfigurationSpace space = space_of(wrist_arm(2.0));
  LinkPoseGoal goal{.link = 6};
  goal.X_WT.position = {0.5, 0.4, 0.6};
  const auto places = [&](std::uint64_t seed) {
    std::vector<Configuration> all;
    for (const ReachedPose& place :
         reach_pose(space, goal, Configuration(6, 0.0), {.tries = 20, .seed = seed})) {
      all.push_back(place.q);
    }
    return all;
  };
  EXPECT_EQ(places(1), places(1));
  EXPECT_NE(places(1), places(2));
}

TEST(ReachPose, RefusesWhatIsNoGoal) {
  const ConfigurationSpace space = space_of(planar_arm(2));
  const auto is_refused = [&](const auto& change) {
    LinkPoseGoal goal = tip_at(1.0, 1.0);
    change(goal);
    try {
      (void)reach_pose(space, goal, {0.0, 0.0});
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_refused([](LinkPoseGoal& goal) { goal.link = 9; }));
  EXPECT_TRUE(is_refused([&](LinkPoseGoal& goal) { goal.X_WT.position.x() = nan; }));
  EXPECT_TRUE(is_refused([](LinkPoseGoal& goal) { goal.X_WT.rotation.coeffs().setZero(); }));
  EXPECT_TRUE(is_refused([](LinkPoseGoal& goal) { goal.position_tolerance = 0.0; }));
  EXPECT_TRUE(is_refused([&](LinkPoseGoal& goal) { goal.rotation_tolerance = nan; }));
  EXPECT_FALSE(is_refused([](LinkPoseGoal&) {}));
}

}  // namespace
}  // namespace firstcontact::test
