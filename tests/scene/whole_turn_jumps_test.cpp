#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/whole_turn_jumps.h>

#include "scene/crane.h"
#include "scene/spinner.h"

namespace firstcontact {
namespace {

using test::spinner;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The joint's angle every 20 ms, as a program records it that keeps angles between -pi and pi.
Trajectory recorded(const std::string& joint, const std::function<double(double)>& angle,
                    bool wrapped, double duration = 4.0) {
  Trajectory trajectory{.joint_names = {joint}, .points = {}};
  for (double time = 0.0; time <= duration; time += 0.02) {
    const double q = angle(time);
    trajectory.points.push_back({time, {wrapped ? std::remainder(q, kTurn) : q}, {}, {}});
  }
  return trajectory;
}

void add_velocities(const std::function<double(double)>& velocity, Trajectory& trajectory) {
  for (TrajectoryPoint& point : trajectory.points) {
    point.velocities = {velocity(point.time)};
  }
}

std::vector<WholeTurnJump> jumps(const Trajectory& trajectory) {
  return whole_turn_jumps(spinner(), trajectory);
}

TEST(WholeTurnJumps, AreFoundInRecordingsThatWrap) {
  const auto found = jumps(recorded(
      "turn", [](double t) { return 0.8 * t * t; }, true));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].joint, "turn");
  EXPECT_EQ(found[0].count, 2u);
  EXPECT_NEAR(found[0].time, std::sqrt(0.5 * kTurn / 0.8), 0.02);
  EXPECT_GT(found[0].from, 3.0);
  EXPECT_LT(found[0].to, -3.0);
  EXPECT_NE(describe(found[0]).find("--unwrap"), std::string::npos);
  EXPECT_NE(describe(found[0]).find("and 1 times more"), std::string::npos);
}

// The wrist may turn twice each way, and has no velocity limit that would tell.
TEST(WholeTurnJumps, AreFoundInJointsWhoseLimitsAreFartherApartThanATurn) {
  const auto angle = [](double t) { return 2.0 * t; };
  EXPECT_EQ(jumps(recorded("wrist", angle, true)).size(), 1u);
  EXPECT_TRUE(jumps(recorded("reach", angle, true)).empty()) << "it cannot be a turn farther";
}

TEST(WholeTurnJumps, AreFoundInJointsThatStandBesideTheEnd) {
  const auto noise = [](double t) { return 0.5 * kTurn + 1e-4 * std::sin(40.0 * t); };
  EXPECT_EQ(jumps(recorded("wrist", noise, true)).size(), 1u);
}

TEST(WholeTurnJumps, AreFoundByVelocitiesInRecordingsOfTwoPoints) {
  Trajectory two{.joint_names = {"wrist"},
                 .points = {{0.0, {3.0}, {0.28}, {}}, {1.0, {-3.0}, {0.28}, {}}}};
  EXPECT_EQ(jumps(two).size(), 1u);
  add_velocities([](double) { return -6.0; }, two);
  EXPECT_TRUE(jumps(two).empty());
}

TEST(WholeTurnJumps, AreNoMotions) {
  EXPECT_TRUE(jumps(recorded(
                        "turn", [](double t) { return 0.8 * t * t; }, false))
                  .empty());
  const auto fast = [](double t) { return 3.0 * std::sin(t); };
  EXPECT_TRUE(jumps(recorded("wrist", fast, false)).empty());
  // Planned by few points: far, but no faster than the joint goes anyway.
  const Trajectory plan{.joint_names = {"wrist"},
                        .points = {{0.0, {-3.0}, {}, {}},
                                   {1.0, {-1.0}, {}, {}},
                                   {2.0, {3.0}, {}, {}},
                                   {3.0, {1.0}, {}, {}}}};
  EXPECT_TRUE(jumps(plan).empty());
  const Trajectory two{.joint_names = {"turn"},
                       .points = {{0.0, {0.0}, {}, {}}, {10.0, {6.0}, {}, {}}}};
  EXPECT_TRUE(jumps(two).empty()) << "within the velocity limit";
}

TEST(WholeTurnJumps, DoNotMatterWhereTheShortWayIsTaken) {
  Trajectory trajectory = recorded(
      "turn", [](double t) { return 0.8 * t * t; }, true);
  trajectory.turning = Turning::shortest;
  EXPECT_TRUE(jumps(trajectory).empty());
}

// Whatever the motion, as long as no step is of half a turn or more.
TEST(Unwrapped, GivesTheMotionThatWasRecorded) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const double a = 10.0 * any(rng);
    const double b = 3.0 * any(rng);
    const double w = 5.0 * any(rng);
    const auto angle = [&](double t) { return a * std::sin(w * t) + b * t; };
    const std::string joint = i % 2 == 0 ? "turn" : "wrist";
    const Trajectory truth = recorded(joint, angle, false);
    const Trajectory mended = unwrapped(spinner(), recorded(joint, angle, true));
    for (std::size_t k = 0; k < truth.points.size(); ++k) {
      ASSERT_NEAR(mended.points[k].positions[0], truth.points[k].positions[0], 1e-12) << i;
    }
  }
}

TEST(Unwrapped, LeavesLengthsAndLimitedJointsAlone) {
  const auto far = [](double t) { return 4.0 * std::cos(40.0 * t); };
  for (const char* joint : {"lift", "turn", "rail/x"}) {
    const Trajectory before = recorded(joint, far, false);
    const Trajectory after = unwrapped(test::crane(), before);
    for (std::size_t k = 0; k < before.points.size(); ++k) {
      ASSERT_EQ(before.points[k].positions, after.points[k].positions) << joint;
    }
  }
}

TEST(Unwrapped, TakesTheAngleOfAPlanarJoint) {
  const auto angle = [](double t) { return 3.0 * t; };
  const Trajectory wrapped = recorded("rail/theta", angle, true);
  EXPECT_EQ(whole_turn_jumps(test::crane(), wrapped).size(), 1u);
  EXPECT_NEAR(unwrapped(test::crane(), wrapped).points.back().positions[0],
              angle(wrapped.points.back().time), 1e-12);
}

}  // namespace
}  // namespace firstcontact
