// A coordinate passes through what was given, and its bounds hold and are tight.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <firstcontact/robot/coordinate_path.h>

#include "robot/chain_case.h"
#include "support/random.h"
#include "support/wide.h"

namespace firstcontact::test {
namespace {

using oracle::Wide;

TEST(CoordinatePath, StaysWithinItsErrorOfTheExactPath) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const CoordinateCase c = random_coordinate(random, 2.0, seed % 2 == 0);
    for (const CoordinateSegment& segment : c.path.segments()) {
      for (const double share : {0.0, 0.1, 0.77, 1.0}) {
        const double t = segment.t_begin + share * (segment.t_end - segment.t_begin);
        for (const oracle::ExactCoordinate& exact : c.exact) {
          if (exact.t_begin != segment.t_begin) {
            continue;
          }
          const CoordinateSegment::State state = segment.state(t);
          const Wide dt = Wide(1.0).scaled(-60);
          const Wide value = exact.value(Wide(t));
          const Wide rate = (exact.value(Wide(t) + dt) - value).scaled(60);
          const Wide bend =
              (exact.value(Wide(t) + dt) + exact.value(Wide(t) - dt) - Wide(2.0) * value)
                  .scaled(120);
          const Wide error = Wide(state.value.hi) + Wide(state.value.lo) - value;
          ASSERT_LE(std::abs(error.nearest()), state.value_error) << seed;
          // The difference quotients are off by 2^-60 of the next derivatives.
          ASSERT_LE(std::abs((Wide(state.rate) - rate).nearest()), state.rate_error + 0x1p-50)
              << seed;
          ASSERT_LE(std::abs((Wide(state.acceleration) - bend).nearest()),
                    state.acceleration_error + 0x1p-45)
              << seed;
        }
      }
    }
  }
}

/// Else an error of infinity would pass.
TEST(CoordinatePath, StatesSmallErrors) {
  const std::array<double, 2> times = {0.25, 0.5};
  const std::array<double, 2> q = {1.0, -2.0};
  const CoordinatePath path = CoordinatePath::quintic(times, q, q, q);
  ASSERT_EQ(path.segments().size(), 3u);  // Rests before and after.
  EXPECT_LE(path.segments()[1].state(0.3).value_error, 1e-23);
  EXPECT_LE(path.segments()[1].state(0.3).rate_error, 1e-13);
  EXPECT_EQ(path.segments()[2].state(0.9).rate, 0.0);
  EXPECT_EQ(path.segments()[2].state(0.9).value.hi, -2.0);
}

TEST(CoordinatePath, PassesThroughWhatWasGiven) {
  const std::array<double, 3> times = {0.0, 0.3, 1.0};
  const std::array<double, 3> q = {1.0, -2.0, 0.5};
  const std::array<double, 3> v = {0.7, 0.0, -3.0};
  const std::array<double, 3> a = {-5.0, 2.0, 9.0};
  const CoordinatePath path = CoordinatePath::quintic(times, q, v, a);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t end = 0; end < 2; ++end) {
      const CoordinateSegment::State state = path.segments()[k].state(times[k + end]);
      EXPECT_NEAR(state.value.hi, q[k + end], 1e-15);
      EXPECT_NEAR(state.rate, v[k + end], 1e-13);
      EXPECT_NEAR(state.acceleration, a[k + end], 1e-12);
    }
  }
}

TEST(CoordinatePath, TakesTheShortestWayOnlyWhenAsked) {
  const std::array<double, 2> times = {0.0, 1.0};
  const std::array<double, 2> q = {0.5, 0.5 + 1.8 * std::numbers::pi};
  const CoordinateSegment given = CoordinatePath::linear(times, q).segments()[0];
  EXPECT_NEAR(given.state(0.5).rate, 1.8 * std::numbers::pi, 1e-14);
  const CoordinateSegment shortest =
      CoordinatePath::linear(times, q, Turning::shortest).segments()[0];
  EXPECT_NEAR(shortest.state(0.5).rate, -0.2 * std::numbers::pi, 1e-14);
  // It ends at the given angle, whole turns apart.
  EXPECT_NEAR(std::cos(shortest.state(1.0).value.hi), std::cos(q[1]), 1e-15);
}

// Angles that count up to whole turns make one path, which does not jump where pieces meet.
TEST(CoordinatePath, TakesTheShortestWayWithoutJumps) {
  std::vector<double> times;
  std::vector<double> q;
  std::vector<double> v;
  for (int k = 0; k <= 50; ++k) {
    times.push_back(k / 50.0);
    q.push_back(std::remainder(-2.5 * k, 2.0 * std::numbers::pi));
    v.push_back(-125.0);
  }
  for (const CoordinatePath& path : {CoordinatePath::linear(times, q, Turning::shortest),
                                     CoordinatePath::cubic(times, q, v, Turning::shortest)}) {
    ASSERT_EQ(path.segments().size(), 50u);
    for (std::size_t k = 0; k < 50; ++k) {
      const CoordinateSegment& segment = path.segments()[k];
      EXPECT_NEAR(segment.state(times[k]).value.hi, -2.5 * static_cast<double>(k), 1e-12);
      EXPECT_NEAR(segment.state(times[k + 1]).value.hi, -2.5 * static_cast<double>(k + 1), 1e-12);
    }
  }
}

TEST(CoordinatePath, TakesHalfATurnTheWayOfTheNumbers) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(shortest_way(0.0, kPi), kPi);
  EXPECT_EQ(shortest_way(kPi, 0.0), -kPi);
  EXPECT_EQ(shortest_way(-kPi / 2, kPi / 2), kPi);
  EXPECT_NEAR(shortest_way(0.0, std::nextafter(kPi, 4.0)), -kPi, 1e-15);
  EXPECT_NEAR(shortest_way(3.0, -3.0), 2.0 * kPi - 6.0, 1e-15);
  EXPECT_NEAR(shortest_way(0.0, 7.0 * kPi - 0.1), kPi - 0.1, 1e-13);
  EXPECT_NEAR(shortest_way(0.0, 7.0 * kPi + 0.1), 0.1 - kPi, 1e-13);
}

/// Sound: no sample exceeds a bound. Tight: on short windows the bound is hardly more.
TEST(CoordinatePath, BoundsHoldAndAreTight) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const CoordinateCase c = random_coordinate(random, 2.0, false);
    for (const CoordinateSegment& segment : c.path.segments()) {
      const double length = segment.t_end - segment.t_begin;
      const double from = segment.t_begin + random.uniform(0.0, 0.9) * length;
      const double to = from + 0.1 * length;
      const CoordinateSegment::Bounds bounds = segment.bounds(from, to);
      const CoordinateSegment::Bounds whole = segment.bounds(segment.t_begin, segment.t_end);
      double rate = 0.0;
      double acceleration = 0.0;
      for (int i = 0; i <= 20; ++i) {
        const CoordinateSegment::State state = segment.state(from + i * (to - from) / 20);
        rate = std::max(rate, std::abs(state.rate) - state.rate_error);
        acceleration =
            std::max(acceleration, std::abs(state.acceleration) - state.acceleration_error);
      }
      ASSERT_LE(rate, bounds.rate);
      ASSERT_LE(acceleration, bounds.acceleration);
      ASSERT_LE(bounds.rate, whole.rate * (1.0 + 1e-12));
      ASSERT_LE(bounds.rate, rate + 0.1 * whole.rate) << seed;
      ASSERT_LE(bounds.acceleration, acceleration + 0.2 * whole.acceleration) << seed;
      // Third derivatives, by difference of seconds.
      const double jerk =
          (segment.state(to).acceleration - segment.state(from).acceleration) / (to - from);
      ASSERT_LE(std::abs(jerk), bounds.jerk * (1.0 + 1e-9) + 1e-9);
    }
  }
}

TEST(CoordinatePath, RefusesWhatHasNoMeaning) {
  const std::array<double, 2> times = {0.0, 1.0};
  const std::array<double, 2> q = {0.0, 1.0};
  const std::array<double, 1> one = {0.0};
  const std::array<double, 2> backwards = {1.0, 0.0};
  const std::array<double, 2> outside = {0.0, 1.5};
  const std::array<double, 2> nan = {0.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW((void)CoordinatePath::linear(times, one), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::linear(backwards, q), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::linear(outside, q), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::linear(nan, q), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::linear(times, nan), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::cubic(times, q, one), std::invalid_argument);
  EXPECT_THROW((void)CoordinatePath::constant(nan[1]), std::invalid_argument);
  const std::array<double, 3> three = {0.0, 0.5, 1.0};
  const std::vector<std::vector<double>> jump = {{0.0, 1.0}, {0.6}};
  EXPECT_THROW((void)CoordinatePath::polynomials(three, jump), std::invalid_argument);
  const std::vector<std::vector<double>> long_one = {std::vector<double>(9, 0.0)};
  EXPECT_THROW((void)CoordinatePath::polynomials(times, long_one), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
