// Limits of joints: which source counts, and what is refused.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include <firstcontact/retiming/joint_limits.h>
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

}  // namespace
}  // namespace firstcontact::test
