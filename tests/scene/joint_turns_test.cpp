#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/scene/trajectory.h>

#include "scene/crane.h"
#include "scene/spinner.h"

namespace firstcontact {
namespace {

using test::spinner;

constexpr double kPi = std::numbers::pi;

Trajectory from_to(const std::string& joint, double from, double to,
                   Turning turning = Turning::shortest) {
  return {.joint_names = {joint},
          .points = {{0.0, {from}, {}, {}}, {1.0, {to}, {}, {}}},
          .turning = turning};
}

/// [rad]  By which the joint turns over the step.
double turned(const RobotModel& robot, const Trajectory& trajectory, const std::string& joint) {
  const TrajectoryMotion motion = joint_motions(robot, trajectory, {}, 1.0);
  const RobotMotion robot_motion(robot, motion.joints);
  const auto segments = robot_motion.coordinate(*robot.find_joint(joint));
  return segments.back().state(1.0).value.hi - segments.front().state(0.0).value.hi;
}

// As MoveIt interpolates a joint without limits: never by more than half a turn, to the same pose.
TEST(TurningShort, TakesContinuousJointsByHalfATurnAtMost) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> angle(-20.0, 20.0);
  for (int i = 0; i < 1000; ++i) {
    const double from = angle(rng);
    const double to = angle(rng);
    const double way = turned(spinner(), from_to("turn", from, to), "turn");
    EXPECT_LE(std::abs(way), kPi + 1e-14) << from << " to " << to;
    EXPECT_NEAR(std::remainder(way - (to - from), 2.0 * kPi), 0.0, 1e-13) << from << " to " << to;
  }
}

TEST(TurningShort, GoesThroughHalfATurnFromThreeToMinusThree) {
  EXPECT_NEAR(turned(spinner(), from_to("turn", 3.0, -3.0), "turn"), 2.0 * kPi - 6.0, 1e-15);
  EXPECT_NEAR(turned(spinner(), from_to("turn", 3.0, -3.0, Turning::as_given), "turn"), -6.0,
              1e-15);
}

// MoveIt compares the difference of doubles with the double next to pi.
TEST(TurningShort, GoesTheWayOfTheNumbersByExactlyHalfATurn) {
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{
           {0.0, kPi}, {kPi, 0.0}, {0.0, -kPi}, {-kPi / 2, kPi / 2}, {kPi / 2, -kPi / 2}}) {
    EXPECT_NEAR(turned(spinner(), from_to("turn", from, to), "turn"), to - from, 1e-15)
        << from << " to " << to;
  }
  EXPECT_LT(turned(spinner(), from_to("turn", 0.0, std::nextafter(kPi, 4.0)), "turn"), 0.0);
}

TEST(TurningShort, LeavesJointsWithLimitsAlone) {
  EXPECT_NEAR(turned(spinner(), from_to("reach", 3.0, -3.0), "reach"), -6.0, 1e-15);
  EXPECT_NEAR(turned(spinner(), from_to("wrist", 6.0, -6.0), "wrist"), -12.0, 1e-15);
}

TEST(TurningShort, TakesTheAngleOfAPlanarJointAndNotItsPlace) {
  const RobotModel crane = test::crane();
  Trajectory trajectory = from_to("rail/theta", 3.0, -3.0);
  trajectory.joint_names.push_back("rail/x");
  trajectory.points[0].positions.push_back(3.0);
  trajectory.points[1].positions.push_back(-3.0);
  const TrajectoryMotion motion = joint_motions(crane, trajectory, {}, 1.0);
  const auto& path = std::get<PlanarPath>(motion.joints.at("rail"));
  EXPECT_NEAR(path[2].segments().back().state(1.0).value.hi, 2.0 * kPi - 3.0, 1e-15);
  EXPECT_EQ(path[0].segments().back().state(1.0).value.hi, -3.0);
}

// One path without jumps, for joints that follow: each point is where the short ways lead.
TEST(TurningShort, DoesNotJumpBetweenPoints) {
  Trajectory trajectory{.joint_names = {"turn"}, .points = {}, .turning = Turning::shortest};
  for (int k = 0; k <= 40; ++k) {
    trajectory.points.push_back({k / 40.0, {std::remainder(0.9 * k, 2.0 * kPi)}, {}, {}});
  }
  const TrajectoryMotion motion = joint_motions(spinner(), trajectory, {}, 1.0);
  const auto& path = std::get<CoordinatePath>(motion.joints.at("turn"));
  double before = 0.0;
  for (const CoordinateSegment& segment : path.segments()) {
    EXPECT_NEAR(segment.state(segment.t_begin).value.hi, before, 1e-13);
    before = segment.state(segment.t_end).value.hi;
  }
  EXPECT_NEAR(before, 36.0, 1e-12);
}

TEST(TurningShort, LeadsJointsThatFollowByWholeNumbers) {
  for (const double multiplier : {1.0, -2.0}) {
    const RobotModel robot = spinner(test::Follower{JointType::continuous, multiplier});
    EXPECT_NEAR(turned(robot, from_to("turn", 3.0, -3.0), "follow"), multiplier * (2.0 * kPi - 6.0),
                1e-14);
  }
}

// After a whole turn a rack, or a gear of another size, is elsewhere: the numbers hold.
TEST(TurningShort, IsTheLongWayWhereAFollowerShowsWholeTurns) {
  for (const test::Follower& follower :
       {test::Follower{JointType::prismatic, 1.0}, test::Follower{JointType::continuous, 0.5},
        test::Follower{JointType::revolute, -1.5}}) {
    const RobotModel robot = spinner(follower);
    EXPECT_NEAR(turned(robot, from_to("turn", 3.0, -3.0), "turn"), -6.0, 1e-15);
    EXPECT_NEAR(turned(robot, from_to("turn", 3.0, -3.0), "follow"), -6.0 * follower.multiplier,
                1e-14);
    EXPECT_EQ(joint_turns(robot, from_to("turn", 3.0, -3.0)).at(0).turning, Turning::as_given);
  }
}

TEST(JointTurns, SayWhichWayAndHowFar) {
  const std::vector<JointTurn> turns = joint_turns(spinner(), from_to("turn", 3.0, -3.0));
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_EQ(turns[0].joint, "turn");
  EXPECT_EQ(turns[0].from, 3.0);
  EXPECT_EQ(turns[0].to, -3.0);
  EXPECT_NEAR(turns[0].turned, 2.0 * kPi - 6.0, 1e-15);
  EXPECT_EQ(turns[0].turning, Turning::shortest);
  EXPECT_TRUE(turns[0].differs);
  const JointTurn given = joint_turns(spinner(), from_to("turn", 3.0, -3.0, Turning::as_given))[0];
  EXPECT_EQ(given.turned, -6.0);
  EXPECT_EQ(given.turning, Turning::as_given);
  EXPECT_FALSE(joint_turns(spinner(), from_to("turn", 0.0, 1.0))[0].differs);
  EXPECT_TRUE(joint_turns(spinner(), from_to("turn", 1.0, 1.0)).empty()) << "it rests";
  EXPECT_TRUE(joint_turns(spinner(), from_to("wrist", 1.0, 2.0)).empty()) << "it has limits";
}

TEST(StraightMotion, TakesTheTimeOfTheWayThatIsTaken) {
  const JointPositions start{{"turn", 3.0}};
  const JointPositions goal{{"turn", -3.0}};
  const Trajectory by_default = straight_motion(spinner(), start, goal);
  EXPECT_NEAR(by_default.points[1].time, 2.0 * kPi - 6.0, 1e-9);
  EXPECT_EQ(by_default.points[1].positions[0], -3.0) << "the numbers stay those that were given";
  EXPECT_EQ(by_default.turning, Turning::shortest);
  EXPECT_NEAR(straight_motion(spinner(), start, goal, Turning::as_given).points[1].time, 6.0, 1e-9);
  const RobotModel geared = spinner(test::Follower{JointType::prismatic, 1.0});
  EXPECT_NEAR(straight_motion(geared, start, goal).points[1].time, 6.0, 1e-9);
}

TEST(Turning, HasTwoWords) {
  EXPECT_EQ(turning_of("long"), Turning::as_given);
  EXPECT_STREQ(to_string(turning_of("short")), "short");
  EXPECT_THROW((void)turning_of("shortest"), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
