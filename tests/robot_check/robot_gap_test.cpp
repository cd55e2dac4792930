// The gap of robots at single times: closed forms, and what counts as contact.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_gap.h>

#include "robot/planar_arm.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector2d;

constexpr double kBallRadius = 0.1;  // [m]

Motion flat_at(const Vector2d& place) {
  return Motion::fixed({{place.x(), place.y(), 0.0}, Eigen::Quaterniond::Identity()});
}

/// Three bars that fold up beside a ball.
const std::vector<std::array<double, 2>> kTurns = {{0.0, 0.8}, {0.2, 2.4}, {0.1, 2.2}};
const Vector2d kPlace(0.4, 1.7);

RobotScene folding(const PairRules& rules = PairRules()) {
  std::vector<CoordinatePath> paths;
  for (const auto& [from, to] : kTurns) {
    paths.push_back(ramp(from, to));
  }
  RobotScene scene(rules);
  scene.add_robot("arm", planar_motion(paths));
  scene.add_body("ball", make_sphere(kBallRadius), flat_at(kPlace));
  return scene;
}

/// Computes the gap of the bars that are not neighbours, and of each bar and the ball.
double expected_gap(double t) {
  std::vector<double> angles;
  for (const auto& [from, to] : kTurns) {
    angles.push_back(from + t * (to - from));
  }
  const std::vector<Vector2d> p = hinges(angles);
  double least = segments_distance(p[0], p[1], p[2], p[3]) - 2.0 * kBarRadius;
  for (std::size_t k = 0; k < 3; ++k) {
    least = std::min(least, segment_distance(kPlace, p[k], p[k + 1]) - kBarRadius - kBallRadius);
  }
  return std::max(least, 0.0);
}

std::vector<double> many_times() {
  std::vector<double> times;
  for (int k = 0; k <= 200; ++k) {
    times.push_back(k / 200.0);
  }
  return times;
}

TEST(RobotGap, IsThatOfThePlanarArmInClosedForm) {
  const std::vector<double> times = many_times();
  const std::vector<RobotGap> gaps = robot_gaps(folding(), times);
  ASSERT_EQ(gaps.size(), times.size());
  int contacts = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double expected = expected_gap(times[k]);
    EXPECT_NEAR(gaps[k].distance, expected, 1e-14) << times[k];
    EXPECT_LE(gaps[k].lower_bound, gaps[k].distance);
    EXPECT_GE(gaps[k].lower_bound, gaps[k].distance - 1e-12);
    EXPECT_EQ(gaps[k].contact, expected == 0.0) << times[k];
    contacts += gaps[k].contact ? 1 : 0;
  }
  EXPECT_GT(contacts, 10);
  EXPECT_LT(contacts, 190);
}

TEST(RobotGap, IsPositiveWhereACheckProvesFreedom) {
  const SceneResult result = check_robots(folding());
  ASSERT_EQ(result.verdict, Verdict::contact);
  for (const double t : many_times()) {
    if (t < result.t) {
      EXPECT_FALSE(robot_gaps(folding(), {&t, 1})[0].contact);
    }
  }
  EXPECT_NEAR(robot_gaps(folding(), {&result.t, 1})[0].distance, 0.0, 1e-6);
}

TEST(RobotGap, CountsMarginsPaddingAndTrackingErrorsAsContactOnly) {
  const double t = 0.0;
  const double gap = expected_gap(t);
  RobotScene padded = folding();
  padded.set_padding(*padded.find_member("arm/l2"), 1.01 * gap);
  RobotScene uncertain = folding();
  uncertain.set_tracking_error(0, "j1", {.angle = 1.5});
  for (const RobotScene& scene : {folding(PairRules(1.01 * gap)), padded, uncertain}) {
    const RobotGap found = robot_gaps(scene, {&t, 1})[0];
    EXPECT_TRUE(found.contact);
    EXPECT_NEAR(found.distance, gap, 1e-14);
  }
  EXPECT_FALSE(robot_gaps(folding(PairRules(0.99 * gap)), {&t, 1})[0].contact);
}

TEST(RobotGap, LeavesOutALinkAndWhatItCarries) {
  RobotScene scene;
  scene.add_robot("arm", planar_motion({ramp(0.0, 1.0)}));
  const std::size_t ball =
      scene.add_body("ball", make_sphere(kBallRadius), flat_at({0.5, kBarRadius + kBallRadius}));
  scene.attach({.body = ball, .link = *scene.find_member("arm/l0"), .t_from = 0.5});
  const std::vector<RobotGap> gaps = robot_gaps(scene, std::vector{0.0, 0.75});
  EXPECT_LT(gaps[0].distance, 0.1);
  EXPECT_EQ(gaps[1].distance, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(gaps[1].contact);
}

TEST(RobotGap, EndsOnAStopAndRefusesOtherTimes) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(robot_gaps(folding(), many_times(), stop.get_token()).empty());
  for (const double t : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)robot_gaps(folding(), {&t, 1}), std::invalid_argument) << t;
  }
}

}  // namespace
}  // namespace firstcontact::test
