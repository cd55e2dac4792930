// The proof of what a controller executes, from the file that it takes.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/stop_motion.h>
#include <firstcontact/retiming/write_trajectory.h>

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

// What is proven is the file: a number changed in it changes the answer.
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
