// Several robots as one motion: the pairs between them, the limits of each, and the names of all.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/joint_limits.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/parse_error.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// Two balls of radius 0.05 in one plane. Ball a runs along x through the place where b starts.
RetimingScene two_gantries() {
  RetimingScene where;
  for (const char* name : {"a", "b"}) {
    where.scene.add_robot(name, RobotMotion(gantry(), {{"x", ramp(0, 0)}, {"y", ramp(0, 0)}}));
  }
  where.robots = {0, 1};
  return where;
}

/// b leaves the way of a in step with it, then both move on.
const WaypointPath kCrossing{{"a/x", "b/y"}, {{-0.5, 0.0}, {0.5, 1.0}, {0.3, 1.4}}};
const std::vector<RateLimits> kLimitsOfBoth{{1.0, 4.0, 80.0}, {0.4, 1.5, 40.0}};
const std::vector<RateLimits> kLooseOfBoth(2, {100.0, 1e4, std::nullopt});
constexpr std::array kModes{RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal};

bool is_of_the_balls(const RetimingScene& where, const ExecutedProof& proof) {
  const BodyPair& members = proof.contact.pairs.at(proof.contact.first.value()).members;
  return where.scene.name(members[0]) == "a/ball" && where.scene.name(members[1]) == "b/ball";
}

TEST(SeveralRobots, AreTimedWithinTheLimitsOfEach) {
  const RetimingScene where = two_gantries();
  double before = 1e9;
  for (const RetimingMode mode : kModes) {
    const RetimedMotion retimed = retime(kCrossing, kLimitsOfBoth, where, {.mode = mode});
    ASSERT_TRUE(retimed.proof.is_proven());
    EXPECT_EQ(retimed.mode, mode);
    const double duration = retimed.motion.duration();
    EXPECT_LE(duration, before);
    before = duration;
    for (double t = 0.0; t <= duration; t += 1e-3) {
      const ControllerState a = controller_state(retimed.motion, 0, t);
      const ControllerState b = controller_state(retimed.motion, 1, t);
      EXPECT_LE(std::abs(a.velocity), kLimitsOfBoth[0].velocity) << t;
      EXPECT_LE(std::abs(b.velocity), kLimitsOfBoth[1].velocity) << t;
      EXPECT_LE(std::abs(a.acceleration), kLimitsOfBoth[0].acceleration) << t;
      EXPECT_LE(std::abs(b.acceleration), kLimitsOfBoth[1].acceleration) << t;
      EXPECT_GT(std::hypot(a.position, b.position), 0.1) << t;
    }
  }
}

// In step the balls stay sqrt(1/8) apart, centre to centre. With b half a second late they meet
// where a is a diameter before it.
TEST(SeveralRobots, MeetWhenOneIsLate) {
  const RetimingScene where = two_gantries();
  TimedMotion motion{{"a/x", "b/y"}, {{0, {-0.5, 0.0}}, {kSecond, {0.5, 1.0}}}};
  const ExecutedProof in_step = prove_motion(motion, kLooseOfBoth, where, {.closest = true});
  EXPECT_EQ(in_step.contact.verdict, Verdict::free);
  const PairAnswer& closest = in_step.contact.pairs.at(in_step.contact.closest.value());
  EXPECT_NEAR(closest.closest->distance, std::sqrt(0.125) - 0.1, 1e-6);
  motion.points = {{0, {-0.5, 0.0}}, {kSecond / 2, {0.0, 0.0}}, {3 * kSecond / 2, {1.0, 1.0}}};
  const ExecutedProof late = prove_motion(motion, kLooseOfBoth, where);
  EXPECT_EQ(late.contact.verdict, Verdict::contact);
  EXPECT_NEAR(late.contact_time(), 0.4, 1e-5);
  EXPECT_TRUE(is_of_the_balls(where, late));
}

TEST(SeveralRobots, AreRefusedOnAPathOnWhichTheyMeet) {
  const RetimingScene where = two_gantries();
  const WaypointPath one_after_the_other{{"a/x", "b/y"}, {{-0.5, 0.0}, {0.5, 0.0}, {0.5, 1.0}}};
  for (const RetimingMode mode : kModes) {
    const RetimedMotion retimed = retime(one_after_the_other, kLimitsOfBoth, where, {.mode = mode});
    EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact);
    EXPECT_TRUE(is_of_the_balls(where, retimed.proof));
  }
}

TEST(SeveralRobots, HoldWithTheTrackingErrorsOfEach) {
  const TimedMotion motion{{"a/x", "b/y"}, {{0, {-0.5, 0.0}}, {kSecond, {0.5, 1.0}}}};
  for (const std::size_t robot : {0, 1}) {
    RetimingScene where = two_gantries();
    where.scene.set_tracking_error(robot, robot == 0 ? "x" : "y", {.distance = 0.2});
    EXPECT_EQ(prove_motion(motion, kLooseOfBoth, where).contact.verdict, Verdict::free);
    where.scene.set_tracking_error(robot, robot == 0 ? "x" : "y", {.distance = 0.3});
    EXPECT_NE(prove_motion(motion, kLooseOfBoth, where).contact.verdict, Verdict::free);
  }
}

// A number of one robot that is changed in the file changes the answer.
TEST(SeveralRobots, AreProvenByTheFile) {
  const RetimingScene where = two_gantries();
  const RobotModel model = joined_model(where);
  const TimedMotion motion = retime(kCrossing, kLimitsOfBoth, where).motion;
  TimedMotion other = motion;
  for (TimedPoint& point : other.points) {
    point.positions[1] = point.time == 0 ? 0.0 : point.positions[1] - 0.6;
  }
  for (const auto format :
       {TrajectoryFormat::yaml, TrajectoryFormat::json, TrajectoryFormat::csv}) {
    const std::string name =
        std::string("motion") + kTrajectoryEndings[static_cast<std::size_t>(format)];
    const auto proof_of = [&](const TimedMotion& written) {
      return prove_motion(parse_timed_motion(write_trajectory(written, format), name, model),
                          kLimitsOfBoth, where);
    };
    EXPECT_TRUE(proof_of(motion).is_proven());
    const ExecutedProof refuted = proof_of(other);
    EXPECT_FALSE(refuted.holds_limits());
    EXPECT_EQ(refuted.contact.verdict, Verdict::contact);
  }
}

std::string error_of(const auto& call) {
  try {
    (void)call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

/// A slide with limits, a slide that follows it, and a planar joint.
RobotModel cart() {
  RobotDescription robot{.name = "cart", .links = {}, .joints = {}};
  for (const char* name : {"floor", "cart", "lift", "fork"}) {
    robot.links.push_back({name, {}, {}});
  }
  Joint base{.name = "base", .type = JointType::planar, .parent = "floor", .child = "cart"};
  Joint lift{.name = "lift", .type = JointType::prismatic, .parent = "cart", .child = "lift"};
  lift.limits = {.lower = 0.0, .upper = 0.5, .velocity = 0.3};
  Joint fork{.name = "fork", .type = JointType::prismatic, .parent = "lift", .child = "fork"};
  fork.mimic = {.joint = "lift"};
  robot.joints = {base, lift, fork};
  return RobotModel(robot);
}

RetimingScene cart_and_gantry() {
  RetimingScene where;
  where.scene.add_robot("fixture", RobotMotion(planar_arm(1), {{"j0", ramp(0, 0)}}));
  const PlanarPath at_rest{ramp(0, 0), ramp(0, 0), ramp(0, 0)};
  where.scene.add_robot("cart", RobotMotion(cart(), {{"base", at_rest}, {"lift", ramp(0, 0)}}));
  where.scene.add_robot("gantry", RobotMotion(gantry(), {{"x", ramp(0, 0)}, {"y", ramp(0, 0)}}));
  where.robots = {2, 1};
  return where;
}

TEST(JoinedModel, HasTheJointsOfEachWithTheirLimits) {
  const RetimingScene where = cart_and_gantry();
  const RobotModel model = joined_model(where);
  for (const char* name : {"gantry/x", "gantry/y", "cart/base/theta", "cart/lift", "cart/fork"}) {
    EXPECT_EQ(coordinate_name(model, find_coordinate(model, name)), name);
  }
  const Joint& fork = model.joints()[model.find_joint("cart/fork").value()];
  EXPECT_EQ(fork.mimic.value().joint, "cart/lift");
  const auto limits =
      limits_of(model, {"gantry/y", "cart/lift"},
                parse_joint_limits("joint_limits: {gantry/y: {max_velocity: 2, max_jerk: 9}}",
                                   "l.yaml", model),
                {.velocity = 7.0, .acceleration = 1.0, .jerk = {}});
  EXPECT_EQ(limits[0].velocity, 2.0);
  EXPECT_EQ(limits[0].jerk, 9.0);
  EXPECT_EQ(limits[1].velocity, 0.3);
  const std::string error = error_of([&] {
    return parse_joint_limits("joint_limits: {lift: {max_velocity: 2}}", "l.yaml", model);
  });
  EXPECT_NE(error.find("cart/lift"), std::string::npos) << error;
}

TEST(JoinedModel, OfOneRobotIsThatRobot) {
  RetimingScene where = cart_and_gantry();
  where.robots = {1};
  EXPECT_TRUE(joined_model(where).find_joint("lift").has_value());
  where.robots = {1, 1};
  EXPECT_THROW((void)joined_model(where), std::invalid_argument);
  where.robots = {1, 3};
  EXPECT_THROW((void)joined_model(where), std::invalid_argument);
  where.robots = {};
  EXPECT_THROW((void)joined_model(where), std::invalid_argument);
}

TEST(SplitMotion, GivesEachRobotItsColumnsAndNames) {
  const RetimingScene where = cart_and_gantry();
  const std::vector<std::string> names{"cart/lift", "gantry/y", "cart/base/theta"};
  const TimedMotion motion{names, {{0, {1, 2, 3}, {4, 5, 6}}, {7, {8, 9, 10}, {11, 12, 13}}}};
  const std::vector<TimedMotion> parts = split_motion(motion, where);
  ASSERT_EQ(parts.size(), 2);
  EXPECT_EQ(parts[0].joint_names, std::vector<std::string>{"y"});
  EXPECT_EQ(parts[1].joint_names, (std::vector<std::string>{"lift", "base/theta"}));
  EXPECT_EQ(parts[0].points[1].time, 7);
  EXPECT_EQ(parts[0].points[1].positions, std::vector<double>{9});
  EXPECT_EQ(parts[1].points[1].velocities, (std::vector<double>{11, 13}));
  EXPECT_FALSE(parts[1].has_accelerations());
  const std::string error = error_of([&] { return split_motion({{"lift"}, {{0, {0.0}}}}, where); });
  EXPECT_NE(error.find("cart/lift"), std::string::npos) << error;
}

// Positions beyond the limits of the second robot are its own; the fixture is none of them.
TEST(ProveMotion, NamesTheRobotThatLeavesItsLimits) {
  const RetimingScene where = cart_and_gantry();
  const TimedMotion motion{{"gantry/x", "cart/lift"}, {{0, {0.0, 0.4}}, {kSecond, {0.1, 0.6}}}};
  const ExecutedProof proof = prove_motion(motion, kLooseOfBoth, where);
  ASSERT_FALSE(proof.positions.empty());
  EXPECT_EQ(proof.positions.front().robot, 1);
  EXPECT_EQ(proof.positions.front().violations.front().what, JointLimit::upper_position);
}

}  // namespace
}  // namespace firstcontact::test
