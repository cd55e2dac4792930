// Blends in place of rests: within limits, on known curves, free, and never slower.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/stop_motion.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

const std::vector<RateLimits> kGantryLimits{{1.0, 5.0, 100.0}, {1.0, 5.0, 100.0}};

TEST(BlendMotion, HoldsItsLimitsAndIsNoSlowerThanRests) {
  std::mt19937 rng(21);
  double blended_time = 0.0;
  double stop_time = 0.0;
  for (int round = 0; round < 30; ++round) {
    const WaypointPath path = random_path(rng, 7, 6, round % 3 == 0 ? 0.1 : 1.5);
    const std::vector<RateLimits> limits = random_limits(rng, 7, round % 2 == 0);
    const BlendedMotion blended =
        blend_motion(path, limits, std::vector<double>(4, kLongestBlend), 1.0 - 1e-4);
    const auto beyond = rate_beyond_limit(rate_report(blended.motion, limits));
    EXPECT_FALSE(beyond.has_value()) << round << ": " << describe(*beyond, "joint", false);
    EXPECT_EQ(blended.motion.points.front().positions, path.waypoints.front());
    EXPECT_EQ(blended.motion.points.back().positions, path.waypoints.back());
    if (round % 2 == 0) {
      blended_time += blended.motion.duration();
      stop_time += stop_motion(path, limits).duration();
    }
  }
  EXPECT_LT(blended_time, 0.85 * stop_time);
}

// Each blend is as fast as its neighbours let it be: no edge is too short for its change of rate.
TEST(BlendMotion, HoldsItsLimitsOnLongPaths) {
  std::mt19937 rng(23);
  const WaypointPath path = random_path(rng, 3, 2000, 0.3);
  const std::vector<RateLimits> limits = random_limits(rng, 3, true);
  const BlendedMotion blended =
      blend_motion(path, limits, std::vector<double>(1998, kLongestBlend), 1.0 - 1e-4);
  EXPECT_FALSE(rate_beyond_limit(rate_report(blended.motion, limits)).has_value());
  EXPECT_LT(blended.motion.duration(), 0.85 * stop_motion(path, limits).duration());
}

// With blends of length 0 it is the motion with rests.
TEST(BlendMotion, WithoutLengthItRests) {
  std::mt19937 rng(22);
  const WaypointPath path = random_path(rng, 3, 5, 1.0);
  const std::vector<RateLimits> limits = random_limits(rng, 3, true);
  const BlendedMotion blended = blend_motion(path, limits, {0.0, 0.0, 0.0});
  EXPECT_EQ(blended.motion.points.back().time, stop_motion(path, limits).points.back().time);
  EXPECT_LE(deviation_from_edges(blended.motion, path), 1e-14);
}

// The controller's quintic on a blend is the curve of degree 4 that is promised.
TEST(BlendMotion, IsTheCurveThatIsPromised) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  const BlendedMotion blended = blend_motion(path, kGantryLimits, {kLongestBlend});
  const Blend& blend = blended.blends.front();
  ASSERT_GT(blend.end, blend.begin);
  for (int k = 0; k <= 20; ++k) {
    const double s = k / 20.0;
    const double t =
        (static_cast<double>(blend.begin) + s * static_cast<double>(blend.end - blend.begin)) *
        1e-9;
    const double curve = s * s * s * (1.0 - 0.5 * s);
    const double x = 1.0 - blend.before + 2.0 * blend.before * (s - curve);
    const double y = 2.0 * blend.after * curve;
    EXPECT_NEAR(controller_state(blended.motion, 0, t).position, x, 1e-9) << s;
    EXPECT_NEAR(controller_state(blended.motion, 1, t).position, y, 1e-9) << s;
  }
}

// Edges 1 cm from a post that stands in the corner: the blend cuts it, and is made shorter.
TEST(Retime, ShortensABlendUntilItIsFree) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  const RetimingScene where = gantry_among({{{0.85, 0.15}, 0.09}});
  const BlendedMotion longest = blend_motion(path, kGantryLimits, {kLongestBlend});
  EXPECT_EQ(prove_motion(longest.motion, kGantryLimits, where).contact.verdict, Verdict::contact);
  for (const RetimingMode mode : {RetimingMode::blend, RetimingMode::time_optimal}) {
    const RetimedMotion retimed = retime(path, kGantryLimits, where, {.mode = mode});
    EXPECT_EQ(retimed.mode, mode);
    EXPECT_TRUE(retimed.proof.is_proven());
    EXPECT_GE(retimed.shortened, 1u);
    EXPECT_EQ(retimed.blends, 1u);
    EXPECT_LT(retimed.motion.duration(), retimed.stop_duration);
    // In free space the blend keeps its length, and the motion is faster.
    const RetimedMotion free = retime(path, kGantryLimits, gantry_among({}), {.mode = mode});
    EXPECT_EQ(free.shortened, 0u);
    EXPECT_LT(free.motion.duration(), retimed.motion.duration());
  }
}

// A thin post 10 um from the ball on both edges: only a short blend passes it.
TEST(Retime, ShortensABlendAsOftenAsNeeded) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  const RetimingScene where = gantry_among({{{0.949, 0.051}, 0.001 - 1e-5}});
  const RetimedMotion retimed = retime(path, kGantryLimits, where, {.mode = RetimingMode::blend});
  EXPECT_TRUE(retimed.proof.is_proven());
  EXPECT_LE(retimed.motion.duration(), retimed.stop_duration);
  EXPECT_GE(retimed.shortened, 3u);
}

// Steps with a post in every inner corner: each blend is shortened apart from all others.
TEST(Retime, ShortensManyBlends) {
  WaypointPath path{{"x", "y"}, {{0.0, 0.0}}};
  std::vector<Post> posts;
  for (int k = 0; k < 16; ++k) {
    const double across = k % 2 == 0 ? 1.0 : 0.0;
    const std::vector<double>& from = path.waypoints.back();
    path.waypoints.push_back({from[0] + across, from[1] + 1.0 - across});
    const double side = k % 2 == 0 ? 1.0 : -1.0;  // Inside of the corner.
    posts.push_back(
        {{path.waypoints.back()[0] - 0.06 * side, path.waypoints.back()[1] + 0.06 * side}, 0.009});
  }
  for (const RetimingMode mode : {RetimingMode::blend, RetimingMode::time_optimal}) {
    const RetimedMotion retimed = retime(path, kGantryLimits, gantry_among(posts), {.mode = mode});
    EXPECT_TRUE(retimed.proof.is_proven());
    EXPECT_EQ(retimed.mode, mode);
    EXPECT_EQ(retimed.blends, 15u);
    EXPECT_GE(retimed.shortened, 15u);
    EXPECT_LT(retimed.motion.duration(), retimed.stop_duration);
  }
}

// A post on an edge: no retiming helps; the answer has the pair and the time.
TEST(Retime, RefusesAnEdgeInContact) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  const RetimingScene where = gantry_among({{{0.5, 0.0}, 0.05}});
  for (const RetimingMode mode :
       {RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal}) {
    const RetimedMotion retimed = retime(path, kGantryLimits, where, {.mode = mode});
    EXPECT_FALSE(retimed.proof.is_proven());
    ASSERT_TRUE(retimed.proof.contact.first.has_value());
    const double x = controller_state(retimed.motion, 0, retimed.proof.contact_time()).position;
    EXPECT_NEAR(x, 0.4, 1e-5);
  }
}

TEST(Retime, AReversalOfHalfATurnIsLegal) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}, {1.0, 1.0}}};
  for (const RetimingMode mode :
       {RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal}) {
    const RetimedMotion retimed = retime(path, kGantryLimits, gantry_among({}), {.mode = mode});
    EXPECT_TRUE(retimed.proof.is_proven());
    EXPECT_LE(retimed.motion.duration(), retimed.stop_duration);
  }
}

}  // namespace
}  // namespace firstcontact::test
