// Limits of joints: which source counts, and what is refused.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/retiming/joint_limits.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/text/parse_error.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

RobotModel arm_with_velocities() {
  RobotDescription description{
      .name = "arm", .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}}, .joints = {}};
  Joint first{.name = "j0", .type = JointType::continuous, .parent = "base", .child = "a"};
  first.limits.velocity = 2.0;
  Joint second{.name = "j1", .type = JointType::continuous, .parent = "a", .child = "b"};
  second.limits.velocity = 0.0;
  description.joints = {first, second};
  return RobotModel(description);
}

TEST(JointLimits, TheFirstSourceCounts) {
  const RobotModel robot = arm_with_velocities();
  const auto given = parse_joint_limits(
      "joint_limits:\n"
      "  j0: {has_velocity_limits: false, max_velocity: 9.0, max_acceleration: 4.0,\n"
      "       has_deceleration_limits: true, max_deceleration: -3.0}\n"
      "  j1: {has_jerk_limits: true, max_jerk: 50, has_acceleration_limits: true,\n"
      "       max_acceleration: 6, angle_wraparound: false}\n"
      "default_velocity_scaling_factor: 0.1\n",
      "l.yaml", robot);
  const auto limits =
      limits_of(robot, {"j0", "j1"}, given, {.velocity = 7.0, .acceleration = 8.0, .jerk = {}});
  EXPECT_EQ(limits[0].velocity, 2.0);  // The robot's: the file has none.
  EXPECT_EQ(limits[0].acceleration, 3.0);
  EXPECT_FALSE(limits[0].jerk.has_value());
  EXPECT_EQ(limits[1].velocity, 7.0);  // 0 in the robot is none.
  EXPECT_EQ(limits[1].acceleration, 6.0);
  EXPECT_EQ(limits[1].jerk, 50.0);
}

/// A joint "lead", one that moves -2 times as fast, and one that moves 3 times as fast as that.
RobotModel geared() {
  RobotDescription description{
      .name = "geared",
      .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
      .joints = {}};
  Joint lead{.name = "lead", .type = JointType::continuous, .parent = "base", .child = "a"};
  lead.limits.velocity = 2.0;
  Joint second{.name = "second", .type = JointType::continuous, .parent = "base", .child = "b"};
  second.limits.velocity = 3.0;
  second.mimic = {.joint = "lead", .multiplier = -2.0};
  Joint third{.name = "third", .type = JointType::continuous, .parent = "base", .child = "c"};
  third.mimic = {.joint = "second", .multiplier = 3.0};
  description.joints = {lead, second, third};
  return RobotModel(description);
}

TEST(JointLimits, HoldForJointsThatMimic) {
  const RobotModel robot = geared();
  const auto of = [&](const std::map<std::string, GivenLimits>& given) {
    return limits_of(robot, {"lead"}, given, {.acceleration = 60.0}).front();
  };
  // The velocity of the robot's follower, and the acceleration for all joints.
  EXPECT_NEAR(of({}).velocity, 1.5, 1e-15);
  EXPECT_NEAR(of({}).acceleration, 10.0, 1e-14);
  EXPECT_FALSE(of({}).jerk.has_value());
  // Those that a file has for followers; a greater velocity does not lift the robot's.
  const RateLimits narrow = of({{"second", {.velocity = 8.0, .jerk = 5.0}},
                                {"third", {.velocity = 1.2, .acceleration = 3.0}}});
  EXPECT_NEAR(narrow.velocity, 0.2, 1e-15);
  EXPECT_NEAR(narrow.acceleration, 0.5, 1e-15);
  EXPECT_NEAR(narrow.jerk.value(), 2.5, 1e-15);
  EXPECT_NEAR(of({{"second", {.velocity = 8.0}}}).velocity, 1.5, 1e-15);
  // The leader's own limits count where they are smaller.
  EXPECT_EQ(of({{"lead", {.velocity = 0.1}}}).velocity, 0.1);
}

// The follower is slower than its leader: a motion at the leader's own speed was never proven.
TEST(JointLimits, OfFollowersAreProvenOfAMotion) {
  RetimingScene where;
  where.scene.add_robot("geared", RobotMotion(geared(), {{"lead", ramp(0, 0)}}));
  const std::vector<RateLimits> limits =
      limits_of(geared(), {"lead"}, {{"third", {.jerk = 60.0}}}, {.acceleration = 60.0});
  const RetimedMotion made = retime({{"lead"}, {{0.0}, {1.5}}}, limits, where);
  EXPECT_TRUE(made.proof.is_proven());
  double fastest = 0.0;
  for (const RateUse& use : made.proof.rates) {
    fastest = use.what == JointRate::jerk ? use.bound : fastest;
  }
  EXPECT_LE(6.0 * fastest, 60.0);
  EXPECT_GE(6.0 * fastest, 50.0);
}

TEST(JointLimits, RefuseJointsThatTheRobotDoesNotHave) {
  try {
    (void)limits_of(geared(), {"lead"}, {{"trird", {.velocity = 1.0}}}, {.acceleration = 1.0});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"third\"?"), std::string::npos)
        << error.what();
  }
}

TEST(JointLimits, MissingOnesNameTheJoint) {
  const RobotModel robot = arm_with_velocities();
  const auto error = [&](const GivenLimits& others) -> std::string {
    try {
      (void)limits_of(robot, {"j0", "j1"}, {}, others);
    } catch (const std::invalid_argument& refusal) {
      return refusal.what();
    }
    return "no error";
  };
  EXPECT_EQ(error({.velocity = 1.0, .acceleration = 1.0, .jerk = {}}), "no error");
  EXPECT_EQ(error({.velocity = 1.0, .acceleration = {}, .jerk = {}}),
            "joint \"j0\": expected a limit of the acceleration, got none");
  EXPECT_EQ(error({.velocity = {}, .acceleration = 1.0, .jerk = {}}),
            "joint \"j1\": expected a limit of the velocity, got none");
}

TEST(JointLimits, RefusesAFileThatIsWrong) {
  const RobotModel robot = arm_with_velocities();
  for (const char* text :
       {"joint_limits: {j9: {max_velocity: 1}}", "joint_limits: [1]",
        "joint_limits: {j0: {max_velocity: 0}}", "joint_limits: {j0: {max_velocity: .nan}}",
        "joint_limits: {j0: {has_velocity_limits: true}}",
        "joint_limits: {j0: {maximum_velocity: 1}}", "limits: {}"}) {
    EXPECT_THROW((void)parse_joint_limits(text, "l.yaml", robot), ParseError) << text;
  }
  EXPECT_THROW((void)parse_joint_limits("", "l.txt", robot), ParseError);
}

/// A slide that the robot lets go from -1 m to 1 m.
RobotModel slide() {
  RobotDescription description{.name = "slide", .links = {{"base"}, {"a"}, {"b"}}, .joints = {}};
  Joint first{.name = "x", .type = JointType::prismatic, .parent = "base", .child = "a"};
  first.limits = {.lower = -1.0, .upper = 1.0, .velocity = 1.0};
  Joint second{.name = "turn", .type = JointType::continuous, .parent = "a", .child = "b"};
  second.limits.velocity = 1.0;
  description.joints = {first, second};
  return RobotModel(description);
}

/// The joint and the limit that a motion of slides from 0 to 0.8 m leaves; of robots that are
/// alike.
std::vector<std::pair<std::size_t, double>> left_limits(
    const std::map<std::string, PositionLimits>& positions, std::size_t robots = 1) {
  RetimingScene where;
  where.robots.clear();
  where.positions = positions;
  WaypointPath path{{}, {{}, {}}};
  for (std::size_t k = 0; k < robots; ++k) {
    const std::string name = "r" + std::to_string(k);
    where.robots.push_back(where.scene.add_robot(
        name, RobotMotion(slide(), {{"x", ramp(0, 0)}, {"turn", ramp(0, 0)}})));
    path.joint_names.push_back(robots == 1 ? "x" : name + "/x");
    path.waypoints[0].push_back(0.0);
    path.waypoints[1].push_back(0.8);
  }
  const std::vector<RateLimits> rates(robots, {1.0, 1.0, {}});
  std::vector<std::pair<std::size_t, double>> left;
  for (const SceneLimits& of_robot : retime(path, rates, where).proof.positions) {
    for (const LimitViolation& violation : of_robot.violations) {
      left.emplace_back(of_robot.robot, violation.limit);
    }
  }
  return left;
}

using Left = std::vector<std::pair<std::size_t, double>>;

TEST(JointLimits, NarrowThePositionsOfTheRobot) {
  const auto left_with = [](const std::string& of_x) {
    return left_limits(position_limits_of(
        parse_joint_limits("joint_limits: {x: {" + of_x + "}}", "l.yaml", slide())));
  };
  EXPECT_EQ(left_with("min_position: 0, max_position: 0.9"), Left{});
  EXPECT_EQ(left_with("has_position_limits: true, max_position: 0.5"), (Left{{0, 0.5}}));
  EXPECT_EQ(left_with("min_position: 0.1"), (Left{{0, 0.1}}));
  EXPECT_EQ(left_with("has_position_limits: false, max_position: 0.5"), Left{});
  EXPECT_EQ(left_with("max_velocity: 1"), Left{});
}

TEST(JointLimits, NarrowThePositionsOfOneOfSeveralRobots) {
  EXPECT_EQ(left_limits({{"r1/x", {.lower = {}, .upper = 0.5}}}, 2), (Left{{1, 0.5}}));
}

TEST(JointLimits, RefusesPositionsThatAreWrong) {
  for (const char* text : {"x: {has_position_limits: true}", "x: {min_position: .nan}",
                           "x: {min_position: 1, max_position: 0}", "turn: {max_position: 1}"}) {
    EXPECT_THROW(
        (void)parse_joint_limits("joint_limits: {" + std::string(text) + "}", "l.yaml", slide()),
        ParseError)
        << text;
  }
}

}  // namespace
}  // namespace firstcontact::test
