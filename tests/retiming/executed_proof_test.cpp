// The proof of what a controller executes, from the file that it takes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/stop_motion.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/scene/trajectory.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

const std::vector<RateLimits> kLoose{{100.0, 1e4, std::nullopt}};

// The arm's bar has a radius of 0.05 and the plate is 1 mm thick to either side, from radius 0.5
// on: the bar is free below the angle at which the bar's side meets the plate's corner.
constexpr double kPlate = 1.2;  // [rad]

// Two free waypoints, a cubic between them that overshoots into the plate.
TEST(ProveMotion, FindsTheOvershootOfACubicBetweenFreeWaypoints) {
  const RetimingScene where = arm_beside_plate(1, kPlate);
  TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {0.9}, {0.0}}}};
  const ExecutedProof straight = prove_motion(motion, kLoose, where);
  EXPECT_EQ(straight.contact.verdict, Verdict::free);
  EXPECT_TRUE(straight.is_proven());
  // The waypoints stay, the velocity at the end throws the arm beyond 0.9 rad and back.
  motion.points = {{0, {0.0}, {0.0}},
                   {1'000'000'000, {0.9}, {2.5}},
                   {2'000'000'000, {0.9}, {-2.5}},
                   {3'000'000'000, {0.0}, {0.0}}};
  for (const TimedPoint& point : motion.points) {
    const TimedMotion rest{{"j0"}, {{0, point.positions, {0.0}}, {1'000, point.positions, {0.0}}}};
    EXPECT_EQ(prove_motion(rest, kLoose, where).contact.verdict, Verdict::free);
  }
  const ExecutedProof thrown = prove_motion(motion, kLoose, where);
  EXPECT_EQ(thrown.contact.verdict, Verdict::contact);
  EXPECT_FALSE(thrown.is_proven());
  EXPECT_GT(thrown.contact_time(), 1.0);
  EXPECT_LT(thrown.contact_time(), 1.5);
  EXPECT_GT(controller_state(motion, 0, thrown.contact_time()).position, 0.9);
}

// A controller that looks at its clock a thousand times a second, a millisecond late or early, is
// where the proof has the joint at that time.
TEST(ProveMotion, IsOfTheControllersOwnInterpolation) {
  std::mt19937 rng(41);
  std::uniform_real_distribution<double> jitter(-1e-3, 1e-3);
  const std::vector<RateLimits> limits = random_limits(rng, 2, true);
  const WaypointPath path = random_path(rng, 2, 4, 1.0);
  const TimedMotion motion =
      blend_motion(path, limits, std::vector<double>(2, kLongestBlend), 1.0 - 1e-4).motion;
  const double duration = motion.duration();
  const RobotModel robot = planar_arm(2);
  const TrajectoryMotion joints = joint_motions(robot, trajectory_of(motion), {}, duration);
  for (double tick = 0.0; tick < duration; tick += 1e-3) {
    const double now = std::clamp(tick + jitter(rng), 0.0, duration);
    for (std::size_t joint = 0; joint < 2; ++joint) {
      const auto& proven = std::get<CoordinatePath>(joints.joints.at(path.joint_names[joint]));
      const auto holds = [&](const CoordinateSegment& s) { return now / duration <= s.t_end; };
      const auto segments = proven.segments();
      const auto segment = std::find_if(segments.begin(), segments.end(), holds);
      ASSERT_NE(segment, segments.end());
      EXPECT_NEAR(controller_state(motion, joint, now).position,
                  segment->state(now / duration).value.value(), kRoundingAllowance)
          << now;
    }
  }
}

// The tracking error of the scene counts: with it the same motion is refused.
TEST(ProveMotion, HoldsWithTheTrackingTolerance) {
  RetimingScene where = arm_beside_plate(1, kPlate);
  const TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {1.0}, {0.0}}}};
  EXPECT_EQ(prove_motion(motion, kLoose, where).contact.verdict, Verdict::free);
  where.scene.set_tracking_error(0, "j0", {.angle = 0.1});
  EXPECT_NE(prove_motion(motion, kLoose, where).contact.verdict, Verdict::free);
}

TEST(ProveMotion, RefusesASceneInWhichSomethingElseMoves) {
  RetimingScene where = arm_beside_plate(1, kPlate);
  where.scene.add_body("cart", make_box({0.1, 0.1, 0.1}),
                       Motion::constant_velocity({{5.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                                                 {1.0, 0.0, 0.0}));
  const TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {0.5}, {0.0}}}};
  try {
    (void)prove_motion(motion, kLoose, where);
    FAIL() << "expected an error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("body \"cart\" moves"), std::string::npos)
        << error.what();
  }
}

// A base that turns by two whole turns is at its start again in the middle and at the end.
TEST(ProveMotion, RefusesABaseThatTurns) {
  RetimingScene where;
  const Motion turning =
      Motion::screw({}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 4.0 * std::numbers::pi, 0.0);
  where.scene.add_robot("arm", planar_motion({CoordinatePath::constant(0.0)}, turning));
  const TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {0.5}, {0.0}}}};
  EXPECT_THROW((void)prove_motion(motion, kLoose, where), std::invalid_argument);
}

// No time changes where a joint stands that the path does not move. So its limits, and those of
// what mimics it, are not the motion's; a joint that moves has to keep its own.
TEST(ProveMotion, LeavesJointsThatDoNotMoveBeyondTheirLimits) {
  const RobotModel slides = gantry();
  RobotDescription fingers{.name = "gantry",
                           .links = {slides.links().begin(), slides.links().end()},
                           .joints = {slides.joints().begin(), slides.joints().end()}};
  fingers.links.push_back({"finger", {}, {}});
  Joint finger{.name = "f", .type = JointType::prismatic, .parent = "ball", .child = "finger"};
  finger.mimic = Mimic{.joint = "y", .multiplier = 1.0};
  fingers.joints.push_back(finger);
  for (Joint& joint : fingers.joints) {
    joint.limits = {.lower = -0.04, .upper = joint.name == "x" ? 1.0 : 0.04};
  }
  RetimingScene where;
  where.scene.add_robot("gantry",
                        RobotMotion(RobotModel(fingers), {{"x", ramp(0, 0)}, {"y", ramp(0, 0)}}));
  const std::vector<RateLimits> limits(2, {1.0, 5.0, 50.0});
  const WaypointPath path{{"x", "y"}, {{0, 0.065}, {0.3, 0.065}, {0.1, 0.065}}};
  for (const RetimingMode mode :
       {RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal}) {
    const RetimedMotion retimed = retime(path, limits, where, {.mode = mode});
    EXPECT_TRUE(retimed.proof.is_proven()) << kRetimingModeWords[static_cast<std::size_t>(mode)];
  }
  const WaypointPath moving{{"x", "y"}, {{0, 0.065}, {0.3, 0.066}}};
  const RetimedMotion beyond = retime(moving, limits, where);
  ASSERT_EQ(beyond.proof.positions.size(), 1u);
  EXPECT_EQ(beyond.proof.positions[0].violations.size(), 2u);  // Joint y and its mimic.
}

// The proof is about the file: a changed number in the file changes the answer.
TEST(ProveMotion, ProvesTheFile) {
  const RetimingScene where = arm_beside_plate(1, kPlate);
  const std::vector<RateLimits> limits{{2.0, 10.0, 200.0}};
  const WaypointPath path{{"j0"}, {{0.0}, {1.0}, {-0.5}}};
  const TimedMotion motion = stop_motion(path, limits, 1.0 - 1e-7);
  const RobotModel model = where.scene.robot_motion(0).model();
  const std::string text = write_trajectory(motion, TrajectoryFormat::yaml);
  EXPECT_TRUE(prove_motion(parse_timed_motion(text, "m.yaml", model), limits, where).is_proven());
  TimedMotion other = motion;
  other.points[other.points.size() / 2].positions[0] += 0.4;
  const std::string bad = write_trajectory(other, TrajectoryFormat::yaml);
  const ExecutedProof proof = prove_motion(parse_timed_motion(bad, "m.yaml", model), limits, where);
  EXPECT_FALSE(proof.holds_limits());
  EXPECT_EQ(proof.contact.verdict, Verdict::contact);
}

}  // namespace
}  // namespace firstcontact::test
