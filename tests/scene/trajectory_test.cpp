#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/trajectory.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

using test::crane;

/// [rad or m]  Of a joint with one coordinate.
double position(const TrajectoryMotion& motion, const std::string& joint, double t) {
  const auto& path = std::get<CoordinatePath>(motion.joints.at(joint));
  for (const CoordinateSegment& segment : path.segments()) {
    if (t <= segment.t_end) {
      return segment.state(t).value.hi;
    }
  }
  return NAN;
}

std::string refusal(const Trajectory& trajectory, const JointPositions& held = {}) {
  try {
    (void)joint_motions(crane(), trajectory, held, 10.0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

Trajectory turning(std::vector<TrajectoryPoint> points) {
  return {.joint_names = {"turn"}, .points = std::move(points)};
}

TEST(JointMotions, AreLinearBetweenPositions) {
  const TrajectoryMotion motion =
      joint_motions(crane(), turning({{2.0, {1.0}, {}, {}}, {4.0, {2.0}, {}, {}}}), {}, 10.0);
  EXPECT_EQ(position(motion, "turn", 0.0), 1.0);
  EXPECT_NEAR(position(motion, "turn", 0.25), 1.25, 1e-15);
  EXPECT_NEAR(position(motion, "turn", 0.3), 1.5, 1e-15);
  EXPECT_EQ(position(motion, "turn", 1.0), 2.0);
}

// q = 1 + 3 s^2 - s^3 in seconds s: its positions and velocities at 0 and 2 s define it.
TEST(JointMotions, AreCubicWithVelocities) {
  const auto q = [](double s) { return 1.0 + 3.0 * s * s - s * s * s; };
  const auto v = [](double s) { return 6.0 * s - 3.0 * s * s; };
  const Trajectory trajectory =
      turning({{0.0, {q(0.0)}, {v(0.0)}, {}}, {2.0, {q(2.0)}, {v(2.0)}, {}}});
  const TrajectoryMotion motion = joint_motions(crane(), trajectory, {}, 10.0);
  for (const double s : {0.0, 0.3, 1.1, 1.9, 2.0}) {
    EXPECT_NEAR(position(motion, "turn", s / 10.0), q(s), 1e-13) << s;
  }
}

// So do those of q = s^5 - s^2 with accelerations.
TEST(JointMotions, AreQuinticWithAccelerations) {
  const auto q = [](double s) { return std::pow(s, 5) - s * s; };
  const auto v = [](double s) { return 5.0 * std::pow(s, 4) - 2.0 * s; };
  const auto a = [](double s) { return 20.0 * std::pow(s, 3) - 2.0; };
  const Trajectory trajectory =
      turning({{0.0, {q(0.0)}, {v(0.0)}, {a(0.0)}}, {2.0, {q(2.0)}, {v(2.0)}, {a(2.0)}}});
  const TrajectoryMotion motion = joint_motions(crane(), trajectory, {}, 10.0);
  for (const double s : {0.0, 0.3, 1.1, 1.9, 2.0}) {
    EXPECT_NEAR(position(motion, "turn", s / 10.0), q(s), 1e-12) << s;
  }
}

TEST(JointMotions, HoldWhatTheTrajectoryDoesNotName) {
  const TrajectoryMotion motion =
      joint_motions(crane(), turning({{0.0, {1.0}, {}, {}}}), {{"lift", 0.5}}, 10.0);
  EXPECT_EQ(position(motion, "lift", 0.7), 0.5);
  EXPECT_EQ(motion.at_default, (std::vector<std::string>{"rail/x", "rail/y", "rail/theta"}));
  EXPECT_FALSE(motion.joints.contains("follow"));
  EXPECT_FALSE(motion.joints.contains("weld"));
}

/// [rad or m]
double default_between(std::optional<double> lower, std::optional<double> upper) {
  Joint joint;
  joint.limits.lower = lower;
  joint.limits.upper = upper;
  return default_position(joint);
}

TEST(JointMotions, StayInsideOfLimitsByDefault) {
  EXPECT_EQ(default_between(0.2, 0.4), 0.2);
  EXPECT_EQ(default_between(-0.4, -0.2), -0.2);
  EXPECT_EQ(default_between({}, -0.2), -0.2);
  EXPECT_EQ(default_between(0.2, {}), 0.2);
  EXPECT_EQ(default_between(-1.0, 1.0), 0.0);
}

TEST(JointMotions, LetAMimicJointSayTheSame) {
  Trajectory trajectory{.joint_names = {"lift", "follow"}, .points = {{0.0, {0.5, 0.35}, {}, {}}}};
  EXPECT_EQ(refusal(trajectory), "accepted");
  trajectory.points[0].positions[1] = 0.36;
  EXPECT_EQ(refusal(trajectory),
            "joint \"follow\": expected 0.35 at 0 s, as it mimics \"lift\", got 0.36");
  EXPECT_EQ(refusal(turning({{0.0, {1.0}, {}, {}}}), {{"follow", 0.1}}), "accepted");
  EXPECT_EQ(refusal(turning({{0.0, {1.0}, {}, {}}}), {{"follow", 0.2}}),
            "joint \"follow\": expected 0.1 at 0 s, as it mimics \"lift\", got 0.2");
}

TEST(JointMotions, RefuseWhatMakesNoMotion) {
  EXPECT_EQ(refusal(turning({})), "expected a trajectory of at least one point, got none");
  EXPECT_NE(refusal(turning({{0.0, {}, {}, {}}})), "accepted");
  EXPECT_NE(refusal(turning({{0.0, {1.0}, {1.0, 2.0}, {}}})), "accepted");
  EXPECT_NE(refusal(turning({{0.0, {1.0}, {}, {1.0}}})), "accepted");
  EXPECT_NE(refusal(turning({{0.0, {1.0}, {1.0}, {}}, {1.0, {1.0}, {}, {}}})), "accepted");
  EXPECT_NE(refusal(turning({{0.0, {NAN}, {}, {}}})), "accepted");
  EXPECT_NE(refusal(turning({{11.0, {0.0}, {}, {}}})), "accepted");
  EXPECT_NE(refusal(turning({{1.0, {0.0}, {}, {}}, {1.0, {0.0}, {}, {}}})), "accepted");
  EXPECT_EQ(refusal({.joint_names = {"turn", "turn"}, .points = {{0.0, {1.0, 1.0}, {}, {}}}}),
            "joint \"turn\": expected each joint once, got it twice");
  EXPECT_EQ(refusal(turning({{0.0, {1.0}, {}, {}}}), {{"trun", 0.2}}),
            "expected a joint of the robot, got \"trun\"; did you mean \"turn\"?");
}

RobotModel robot_with(JointType type) {
  return RobotModel(
      {.name = "floater",
       .links = {{"world", {}, {}}, {"tool", {}, {}}},
       .joints = {{.name = "free", .type = type, .parent = "world", .child = "tool"}}});
}

TEST(FindCoordinate, SaysSoWhereNoJointHasOne) {
  try {
    (void)find_coordinate(robot_with(JointType::ball), "free/x");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "expected a joint of the robot, got \"free/x\"; it has no joint with a coordinate");
  }
}

TEST(FindCoordinate, KnowsTheSevenOfAFloatingJoint) {
  const RobotModel robot = robot_with(JointType::floating);
  EXPECT_EQ(find_coordinate(robot, "free/trans_z"), (JointCoordinate{0, 2}));
  EXPECT_EQ(find_coordinate(robot, "free/rot_w"), (JointCoordinate{0, 3}));
  EXPECT_EQ(coordinate_name(robot, {0, 6}), "free/rot_z");
  EXPECT_FALSE(known_coordinate(robot, "free"));
  EXPECT_FALSE(known_coordinate(robot, "free/x"));
  EXPECT_THROW((void)find_coordinate(robot, "free"), std::invalid_argument);
}

TEST(JointMotions, MoveAFloatingJointByTheShortestRotation) {
  const RobotModel robot = robot_with(JointType::floating);
  const double half = std::sqrt(0.5);
  Trajectory trajectory{.joint_names = {"free/trans_x", "free/rot_w", "free/rot_z"},
                        .points = {{.time = 0.0, .positions = {1.0, 1.0, 0.0}},
                                   {.time = 2.0, .positions = {3.0, -half, -half}}}};
  const JointPositions held = {{"free/trans_y", 5.0}};
  const TrajectoryMotion made = joint_motions(robot, trajectory, held, 4.0);
  const Pose middle = std::get<Motion>(made.joints.at("free")).pose(0.25);
  EXPECT_LT((middle.position - Eigen::Vector3d(2, 5, 0)).norm(), 1e-15);
  EXPECT_NEAR(2.0 * std::atan2(middle.rotation.z(), middle.rotation.w()), std::numbers::pi / 4.0,
              1e-15);
  const Pose after = std::get<Motion>(made.joints.at("free")).pose(0.9);
  EXPECT_EQ(after.position, Eigen::Vector3d(3, 5, 0));
  // Nothing names it: it rests where it is held.
  const Trajectory rests{.joint_names = {}, .points = {TrajectoryPoint{}}};
  const TrajectoryMotion still = joint_motions(robot, rests, held, 4.0);
  EXPECT_EQ(std::get<Motion>(still.joints.at("free")).pose(0.5).position, Eigen::Vector3d(0, 5, 0));
  for (TrajectoryPoint& point : trajectory.points) {
    point.velocities = {0.0, 0.0, 0.0};
  }
  EXPECT_THROW((void)joint_motions(robot, trajectory, held, 4.0), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
