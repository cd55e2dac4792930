// Rest at every waypoint: exact edges, limits proven, as fast as can be.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/retiming/detail/line_profile.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/stop_motion.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

constexpr double kShare = 1.0 - 1e-9;

TEST(StopMotion, HoldsItsLimitsAndStaysOnTheEdges) {
  std::mt19937 rng(11);
  for (int round = 0; round < 60; ++round) {
    const bool has_jerk = round % 2 == 0;
    const WaypointPath path = random_path(rng, 7, 6, round % 3 == 0 ? 0.05 : 1.5);
    const std::vector<RateLimits> limits = random_limits(rng, 7, has_jerk);
    const TimedMotion motion = stop_motion(path, limits, 1.0 - 1e-7);
    EXPECT_EQ(motion.has_accelerations(), has_jerk);
    const auto beyond = rate_beyond_limit(rate_report(motion, limits));
    EXPECT_FALSE(beyond.has_value()) << round << ": " << describe(*beyond, "joint", false);
    EXPECT_LE(deviation_from_edges(motion, path), 1e-14) << round;
    EXPECT_EQ(motion.points.front().positions, path.waypoints.front());
    EXPECT_EQ(motion.points.back().positions, path.waypoints.back());
    for (std::size_t k = 1; k < motion.points.size(); ++k) {
      EXPECT_LT(motion.points[k - 1].time, motion.points[k].time);
    }
  }
}

// Closed forms of one joint from rest to rest; the shortest phases take 2 ms at most.
TEST(StopMotion, IsAsFastAsCanBe) {
  struct Case {
    double way;
    RateLimits limits;
    double seconds;
  };
  const std::vector<Case> cases{
      // Trapezoid: 2 s of ramps by 1 m each, then 1 s of cruise at 2.
      {4.0, {2.0, 2.0, std::nullopt}, 3.0},
      // Triangle.
      {1.0, {10.0, 4.0, std::nullopt}, 1.0},
      // Only the jerk counts: way = 2 j T^3, four phases.
      {2.0, {100.0, 100.0, 1.0}, 4.0},
      // Jerk and acceleration: bends of 1 s, straight of 1 s: way = a (Tj + Ta) (2 Tj + Ta) = 6.
      {6.0, {100.0, 1.0, 1.0}, 6.0},
      // All seven phases: that, with a cruise of 2 s at the rate of 2.
      {10.0, {2.0, 1.0, 1.0}, 8.0}};
  for (const Case& c : cases) {
    const WaypointPath path{{"j0"}, {{0.0}, {c.way}}};
    const double seconds = stop_motion(path, {c.limits}, kShare).duration();
    EXPECT_GE(seconds, c.seconds * (1.0 - 1e-6)) << c.way;
    EXPECT_LE(seconds, c.seconds + 0.003) << c.way;
  }
}

// Twice the path takes no less than the path, and a path backward as long as forward.
TEST(StopMotion, TakesAsLongBackward) {
  std::mt19937 rng(12);
  const WaypointPath path = random_path(rng, 3, 5, 1.0);
  WaypointPath backward = path;
  std::reverse(backward.waypoints.begin(), backward.waypoints.end());
  const std::vector<RateLimits> limits = random_limits(rng, 3, true);
  EXPECT_NEAR(stop_motion(path, limits).duration(), stop_motion(backward, limits).duration(), 1e-6);
}

TEST(StopMotion, AReversalIsLegal) {
  const WaypointPath path{{"j0", "j1"}, {{0.0, 0.0}, {1.0, 0.5}, {0.0, 0.0}}};
  const std::vector<RateLimits> limits{{1.0, 5.0, 50.0}, {1.0, 5.0, 50.0}};
  const TimedMotion motion = stop_motion(path, limits, kShare);
  EXPECT_FALSE(rate_beyond_limit(rate_report(motion, limits)).has_value());
  EXPECT_EQ(motion.points.back().positions, path.waypoints.front());
}

// A hair of an edge keeps its limits, too: no phase is so short that rounding matters.
TEST(StopMotion, TinyAndLongEdgesHoldTheirLimits) {
  for (const double way : {1e-12, 1e-9, 1e-6, 1e-3, 100.0}) {
    const WaypointPath path{{"j0"}, {{3.0}, {3.0 + way}}};
    const std::vector<RateLimits> limits{{2.0, 10.0, 1000.0}};
    const TimedMotion motion = stop_motion(path, limits, 1.0 - 1e-6);
    const auto beyond = rate_beyond_limit(rate_report(motion, limits));
    EXPECT_FALSE(beyond.has_value()) << way << ": " << describe(*beyond, "j0", false);
  }
}

// Limits and ways at the ends of the range of doubles: within limits, or a named refusal.
TEST(StopMotion, NamesLimitsThatAreTooSmall) {
  int refused = 0;
  for (const double way : {1e-300, 1e-8, 1.0, 1e8}) {
    for (const double velocity : {5e-324, 1e-300, 1e-12, 1.0, 1e300}) {
      for (const double other : {1e-300, 1.0, 1e300}) {
        const WaypointPath path{{"j0"}, {{0.0}, {way}}};
        const std::vector<RateLimits> limits{{velocity, other, other}};
        try {
          const TimedMotion motion = stop_motion(path, limits, 1.0 - 1e-6);
          EXPECT_FALSE(rate_beyond_limit(rate_report(motion, limits)).has_value())
              << way << " " << velocity << " " << other;
          EXPECT_GT(motion.points.back().time, 0);
        } catch (const std::invalid_argument& error) {
          EXPECT_NE(std::string(error.what()).find("within 13 days"), std::string::npos);
          ++refused;
        }
      }
    }
  }
  EXPECT_GE(refused, 20);
  EXPECT_LE(refused, 45);
}

std::string error_of_path(const WaypointPath& path) {
  try {
    (void)stop_motion(path, std::vector<RateLimits>(path.joint_names.size(), {1.0, 1.0, 1.0}));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(StopMotion, RefusesWhatIsNoPath) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of_path({{"j0"}, {{0.0}}}), "expected a path of two waypoints or more, got 1");
  EXPECT_EQ(error_of_path({{"j0"}, {{0.0}, {1.0}, {1.0}}}),
            "waypoint 3: it repeats the waypoint before it; leave one of them out");
  EXPECT_NE(error_of_path({{"j0"}, {{0.0}, {kNan}}}).find("waypoint 2"), std::string::npos);
  EXPECT_NE(error_of_path({{"j0"}, {{0.0}, {1.0, 2.0}}}).find("waypoint 2"), std::string::npos);
}

TEST(LineProfile, RunsBetweenRatesOverTheWay) {
  std::mt19937 rng(13);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  const detail::LineLimits limits{1.0, 4.0, 40.0};
  for (int round = 0; round < 100; ++round) {
    const double from = number(rng);
    const double to = number(rng);
    const double way = detail::ramp_way(from, to, limits) + 0.05 + number(rng);
    const auto nodes = detail::line_profile(way, from, to, limits);
    EXPECT_EQ(nodes.back().state.x, way);
    EXPECT_EQ(nodes.back().state.rate, to);
    double seconds = 0.0;
    double before = 0.0;
    for (const detail::LineNode& node : nodes) {
      seconds += static_cast<double>(node.after) * 1e-9;
      EXPECT_GE(node.state.x, before - 1e-12);
      before = node.state.x;
      EXPECT_LE(node.state.rate, 1.0 + 1e-6);
      EXPECT_LE(std::abs(node.state.acceleration), 4.0 * (1.0 + 1e-6));
    }
    EXPECT_NEAR(seconds, detail::line_seconds(way, from, to, limits), 0.006) << round;
  }
}

}  // namespace
}  // namespace firstcontact::test
