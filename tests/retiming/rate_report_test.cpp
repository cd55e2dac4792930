// Rates of a controller's interpolation: proven bounds, attained by the motion.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <firstcontact/retiming/rate_report.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

RateUse use_of(const std::vector<RateUse>& report, std::size_t joint, JointRate what) {
  const auto found = std::find_if(report.begin(), report.end(), [&](const RateUse& use) {
    return use.joint == joint && use.what == what;
  });
  EXPECT_NE(found, report.end());
  return *found;
}

/// Random points; the first and the last one rest.
TimedMotion random_points(std::mt19937& rng, bool quintic) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::uniform_int_distribution<std::int64_t> time(5'000'000, 400'000'000);
  TimedMotion motion{{"j0"}, {}};
  std::int64_t now = 0;
  for (int k = 0; k < 6; ++k) {
    const bool is_end = k == 0 || k == 5;
    TimedPoint point{now, {number(rng)}, {is_end ? 0.0 : 3.0 * number(rng)}, {}};
    if (quintic) {
      point.accelerations = {is_end ? 0.0 : 20.0 * number(rng)};
    }
    motion.points.push_back(point);
    now += time(rng);
  }
  return motion;
}

// A cubic from rest to rest over 1 s by 1 rad: its velocity is 1.5 at the middle, its acceleration
// 6 at the ends.
TEST(RateReport, FindsThePeaksOfACubic) {
  const TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {1.0}, {0.0}}}};
  const auto report = rate_report(motion, {{1.5, 6.0, std::nullopt}});
  const RateUse velocity = use_of(report, 0, JointRate::velocity);
  EXPECT_NEAR(velocity.attained, 1.5, 1e-8);
  EXPECT_NEAR(velocity.bound, 1.5, 1e-8);
  EXPECT_LE(velocity.attained, velocity.bound);
  EXPECT_NEAR(velocity.time, 0.5, 1e-4);
  const RateUse acceleration = use_of(report, 0, JointRate::acceleration);
  EXPECT_NEAR(acceleration.attained, 6.0, 1e-8);
  EXPECT_NEAR(acceleration.bound, 6.0, 1e-8);
}

// Dense sampling never gets past the bound, and comes close to it.
TEST(RateReport, BoundsWhatAControllerDoesAndNoMore) {
  std::mt19937 rng(3);
  for (int round = 0; round < 40; ++round) {
    const TimedMotion motion = random_points(rng, round % 2 == 0);
    const auto report = rate_report(motion, {{1.0, 1.0, std::nullopt}});
    double velocity = 0.0;
    double acceleration = 0.0;
    constexpr int kSamples = 4000;
    for (int k = 0; k <= kSamples; ++k) {
      const ControllerState state =
          controller_state(motion, 0, motion.duration() * k / static_cast<double>(kSamples));
      velocity = std::max(velocity, std::abs(state.velocity));
      acceleration = std::max(acceleration, std::abs(state.acceleration));
    }
    const RateUse v = use_of(report, 0, JointRate::velocity);
    const RateUse a = use_of(report, 0, JointRate::acceleration);
    EXPECT_LE(velocity, v.bound * (1.0 + 1e-12)) << round;
    EXPECT_LE(acceleration, a.bound * (1.0 + 1e-9)) << round;
    EXPECT_GE(velocity, v.attained * 0.99) << round;
    EXPECT_GE(acceleration, a.attained * 0.97) << round;
    EXPECT_LE(v.bound, v.attained * (1.0 + 1e-8)) << round;
    EXPECT_LE(a.bound, a.attained * (1.0 + 1e-8)) << round;
    const double at = std::abs(controller_state(motion, 0, v.time).velocity);
    EXPECT_NEAR(at, v.attained, 1e-4 * v.attained) << round;
  }
}

// At 1001 instants a controller would see no violation, between two of them there is one.
TEST(RateReport, FindsALimitExceededOnlyBetweenGridPoints) {
  // The velocity of the quintic has its peak at 0.4 and falls off by 1e-7 within a grid step.
  const TimedMotion motion{{"j0"},
                           {{0, {0.0}, {0.0}, {0.0}},
                            {700'000'000, {1.0}, {1.0}, {0.0}},
                            {1'777'000'000, {1.3}, {0.0}, {0.0}}}};
  const auto peak = use_of(rate_report(motion, {{1.0, 1e3, std::nullopt}}), 0, JointRate::velocity);
  double grid = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    grid = std::max(grid,
                    std::abs(controller_state(motion, 0, motion.duration() * k / 1000.0).velocity));
  }
  ASSERT_LT(grid, peak.attained * (1.0 - 1e-9));
  const double limit = 0.5 * (grid + peak.attained);
  const auto report = rate_report(motion, {{limit, 1e3, std::nullopt}});
  const auto beyond = rate_beyond_limit(report);
  ASSERT_TRUE(beyond.has_value());
  EXPECT_TRUE(beyond->is_beyond());
  EXPECT_EQ(beyond->what, JointRate::velocity);
  EXPECT_GT(std::abs(controller_state(motion, 0, beyond->time).velocity), limit);
  const auto wider = rate_report(motion, {{peak.bound, 1e3, std::nullopt}});
  EXPECT_FALSE(rate_beyond_limit(wider).has_value());
}

TEST(RateReport, JumpsAreInfinite) {
  const TimedMotion linear{{"j0"}, {{0, {0.0}}, {1'000'000'000, {1.0}}, {2'000'000'000, {1.5}}}};
  const auto report = rate_report(linear, {{1.1, 100.0, std::nullopt}});
  EXPECT_TRUE(use_of(report, 0, JointRate::velocity).is_within());
  EXPECT_TRUE(use_of(report, 0, JointRate::acceleration).is_beyond());
  // A cubic whose accelerations differ at a point has an infinite jerk; a velocity at the end too.
  const TimedMotion cubic{
      {"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {1.0}, {0.0}}, {2'000'000'000, {1.5}, {0.0}}}};
  EXPECT_TRUE(use_of(rate_report(cubic, {{9.0, 99.0, 1e9}}), 0, JointRate::jerk).is_beyond());
  TimedMotion thrown = cubic;
  thrown.points.back().velocities = {0.1};
  EXPECT_TRUE(use_of(rate_report(thrown, {{9.0, 99.0, std::nullopt}}), 0, JointRate::acceleration)
                  .is_beyond());
  EXPECT_FALSE(use_of(rate_report(cubic, {{9.0, 99.0, std::nullopt}}), 0, JointRate::acceleration)
                   .is_beyond());
}

TEST(RateReport, RefusesLimitsThatAreNone) {
  const TimedMotion motion{{"j0"}, {{0, {0.0}, {0.0}}, {1'000'000'000, {1.0}, {0.0}}}};
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)rate_report(motion, {{bad, 1.0, std::nullopt}}), std::invalid_argument);
    EXPECT_THROW((void)rate_report(motion, {{1.0, bad, std::nullopt}}), std::invalid_argument);
    EXPECT_THROW((void)rate_report(motion, {{1.0, 1.0, bad}}), std::invalid_argument);
  }
  EXPECT_THROW((void)rate_report(motion, {}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
