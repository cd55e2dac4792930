// Finely sampled paths: waypoints that edges pass closely, reversals, and the distance of blends.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/detail/limit_breaks.h>
#include <firstcontact/retiming/detail/thinned_path.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/retime.h>

#include "retiming_cases.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

const std::vector<RateLimits> kWithoutJerk{{1.0, 2.0, {}}, {1.0, 2.0, {}}};
const std::vector<RateLimits> kWithJerk{{1.0, 2.0, 100.0}, {1.0, 2.0, 100.0}};
constexpr std::array kBlendModes{RetimingMode::blend, RetimingMode::time_optimal};

/// Samples a curve of the gantry at even steps of its parameter in [0, 1].
template <class Curve>
WaypointPath sampled(std::size_t count, const Curve& curve) {
  WaypointPath path{{"x", "y"}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    path.waypoints.push_back(curve(static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  return path;
}

std::vector<double> sine(double s) { return {2.0 * s, 0.3 * std::sin(10.0 * s)}; }
std::vector<double> circle(double s) {
  return {0.5 * std::cos(6.28 * s), 0.5 * std::sin(6.28 * s)};
}
std::vector<double> line(double s) { return {2.0 * s, 1.0 * s}; }

/// The least over the path of the greatest distance of a joint.
///
/// That is convex along an edge, so that thirds of it find the least.
double distance_to_path(const std::vector<double>& q, const WaypointPath& path) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < path.waypoints.size(); ++k) {
    const auto distance = [&](double x) {
      double greatest = 0.0;
      for (std::size_t j = 0; j < q.size(); ++j) {
        const double a = path.waypoints[k][j];
        greatest = std::max(greatest, std::abs(a + x * (path.waypoints[k + 1][j] - a) - q[j]));
      }
      return greatest;
    };
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 40; ++i) {
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    least = std::min(least, distance(0.5 * (low + high)));
  }
  return least;
}

/// The greatest distance of a motion from a path, at many times.
double deviation_of(const TimedMotion& motion, const WaypointPath& path) {
  double greatest = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const double t = motion.duration() * i / 400.0;
    greatest = std::max(greatest, distance_to_path({controller_state(motion, 0, t).position,
                                                    controller_state(motion, 1, t).position},
                                                   path));
  }
  return greatest;
}

TEST(ThinnedPath, StaysWithinItsTolerance) {
  std::mt19937 rng(31);
  for (const double tolerance : {0.0, 1e-3, 0.02, 0.3}) {
    const WaypointPath path = random_path(rng, 2, 60, 0.1);
    const std::vector<std::size_t> kept = detail::thinned_waypoints(path, tolerance, {7});
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), 59u);
    EXPECT_TRUE(std::ranges::find(kept, 7u) != kept.end());
    EXPECT_TRUE(std::ranges::is_sorted(kept));
    const WaypointPath thinned = detail::through_waypoints(path, kept);
    for (const std::vector<double>& waypoint : path.waypoints) {
      EXPECT_LE(distance_to_path(waypoint, thinned), tolerance + 1e-6);
    }
    if (tolerance == 0.3) {
      EXPECT_LT(kept.size(), 30u);
    }
  }
}

// A way back along the same line is no straight edge.
TEST(ThinnedPath, KeepsReversals) {
  const WaypointPath path{{"x", "y"}, {{0, 0}, {0.4, 0}, {0.8, 0}, {0.6, 0}, {0.4, 0}, {1, 0}}};
  EXPECT_EQ(detail::thinned_waypoints(path, 1e-3, {}), (std::vector<std::size_t>{0, 2, 4, 5}));
  const WaypointPath loop{{"x", "y"}, {{0, 0}, {0.4, 0}, {0.8, 0}, {0.4, 0}, {0, 0}}};
  EXPECT_EQ(detail::thinned_waypoints(loop, 1e-3, {}), (std::vector<std::size_t>{0, 2, 4}));
}

TEST(LimitBreaks, NamesTheSegment) {
  TimedMotion motion{{"x"}, {}};
  for (int k = 0; k < 4; ++k) {
    const double x = k == 3 ? 1.0 : 0.1 * k;
    motion.points.push_back({k * 1'000'000'000LL, {x}, {k == 3 ? 0.0 : 0.1}, {0.0}});
  }
  const std::vector<detail::LimitBreak> breaks = detail::limit_breaks(motion, {{0.5, 100.0, {}}});
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks.front().begin, 2'000'000'000);
  EXPECT_EQ(breaks.front().end, 3'000'000'000);
}

// Blends on edges of some milliseconds are no faster than their shortest phase allows.
TEST(BlendMotion, HoldsItsLimitsOnShortEdges) {
  for (const std::size_t count : {300u, 600u, 1000u}) {
    const WaypointPath path = sampled(count, sine);
    const BlendedMotion blended =
        blend_motion(path, kWithoutJerk, std::vector<double>(count - 2, kLongestBlend), 1.0 - 1e-4);
    const auto beyond = rate_beyond_limit(rate_report(blended.motion, kWithoutJerk));
    EXPECT_FALSE(beyond.has_value()) << count << ": " << describe(*beyond, "joint", true);
  }
}

TEST(Retime, DurationsDependLittleOnSampling) {
  for (const auto& curve : {sine, circle}) {
    for (const auto& limits : {kWithoutJerk, kWithJerk}) {
      for (const RetimingMode mode : kBlendModes) {
        double least = std::numeric_limits<double>::infinity();
        double most = 0.0;
        for (const int count : {100, 300, rounds(1000, 200)}) {
          const RetimedMotion retimed = retime(sampled(static_cast<std::size_t>(count), curve),
                                               limits, gantry_among({}), {.mode = mode});
          EXPECT_TRUE(retimed.proof.is_proven());
          EXPECT_EQ(retimed.mode, mode);
          least = std::min(least, retimed.motion.duration());
          most = std::max(most, retimed.motion.duration());
        }
        EXPECT_LT(most, 1.2 * least);
        EXPECT_LT(most, 8.0);  // With rest at 1000 waypoints it takes 70 s.
      }
    }
  }
}

TEST(Retime, AStraightLineIsOneEdgeHoweverItIsDivided) {
  for (const RetimingMode mode : kBlendModes) {
    const RetimedMotion whole =
        retime(sampled(2, line), kWithJerk, gantry_among({}), {.mode = mode});
    const RetimedMotion divided =
        retime(sampled(500, line), kWithJerk, gantry_among({}), {.mode = mode});
    EXPECT_TRUE(divided.proof.is_proven());
    EXPECT_EQ(divided.left_out, 498u);
    EXPECT_NEAR(divided.motion.duration(), whole.motion.duration(), 1e-6);
  }
}

// A post 0.1 mm inside of an arc: chords of 1 mm in height would touch it.
TEST(Retime, TakesWaypointsBackWhereAnEdgeIsNotFree) {
  const auto arc = [](double s) {
    return std::vector<double>{0.5 * std::cos(1.57 * s), 0.5 * std::sin(1.57 * s)};
  };
  const WaypointPath path = sampled(400, arc);
  const double away = (0.5 - 0.05 - 0.02 - 1e-4) / std::sqrt(2.0);
  for (const RetimingMode mode : kBlendModes) {
    const RetimedMotion free = retime(path, kWithoutJerk, gantry_among({}), {.mode = mode});
    const RetimedMotion near =
        retime(path, kWithoutJerk, gantry_among({{{away, away}, 0.02}}), {.mode = mode});
    EXPECT_TRUE(near.proof.is_proven());
    EXPECT_NE(near.mode, RetimingMode::stop);
    EXPECT_LT(near.left_out, free.left_out);
    EXPECT_GT(near.left_out, 300u);
    EXPECT_LT(near.motion.duration(), 0.25 * near.stop_duration);
  }
}

TEST(Retime, RestsWhereTheWayTurnsBack) {
  for (const double aside : {0.0, 0.1}) {
    const WaypointPath path{{"x", "y"}, {{-1.0, 0.0}, {1.0, 0.0}, {-1.0, aside}, {0.0, 1.0}}};
    for (const RetimingMode mode : kBlendModes) {
      const RetimedMotion retimed = retime(path, kWithJerk, gantry_among({}), {.mode = mode});
      EXPECT_TRUE(retimed.proof.is_proven());
      EXPECT_EQ(retimed.blends, 1u);
      EXPECT_TRUE(std::ranges::any_of(retimed.motion.points, [&](const TimedPoint& point) {
        return point.positions == path.waypoints[1] &&
               point.velocities == std::vector<double>{0.0, 0.0};
      }));
    }
  }
}

TEST(Retime, KeepsTheDeviationOfBlends) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.2, 1.0}, {0.0, 0.5}}};
  for (const RetimingMode mode : kBlendModes) {
    const RetimedMotion wide = retime(path, kWithJerk, gantry_among({}), {.mode = mode});
    double before = wide.motion.duration();
    EXPECT_GT(deviation_of(wide.motion, path), 0.05);
    for (const double deviation : {0.05, 0.01, 0.001}) {
      const RetimedMotion near =
          retime(path, kWithJerk, gantry_among({}), {.mode = mode, .blend_deviation = deviation});
      EXPECT_TRUE(near.proof.is_proven());
      EXPECT_LE(deviation_of(near.motion, path), 1.02 * deviation);
      EXPECT_GT(deviation_of(near.motion, path), 0.3 * deviation);
      EXPECT_GE(near.motion.duration(), before);
      EXPECT_LT(near.motion.duration(), near.stop_duration);
      before = near.motion.duration();
    }
    // What is left out counts, too.
    const WaypointPath curve = sampled(300, sine);
    const RetimedMotion near =
        retime(curve, kWithoutJerk, gantry_among({}), {.mode = mode, .blend_deviation = 5e-4});
    EXPECT_LE(deviation_of(near.motion, curve), 1.1 * 5e-4);
    EXPECT_GT(near.left_out, 100u);
  }
}

TEST(Retime, RefusesADeviationThatIsNotPositive) {
  for (const double deviation : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)retime(sampled(3, sine), kWithJerk, gantry_among({}),
                              {.mode = RetimingMode::blend, .blend_deviation = deviation}),
                 std::invalid_argument);
  }
}

// No blend is tried where an edge is in contact: the answer is that of the edges.
TEST(Retime, ProvesTheEdgesFirst) {
  const WaypointPath path{{"x", "y"}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};
  const RetimingScene where = gantry_among({{{0.85, 0.15}, 0.09}, {{0.5, 1.0}, 0.05}});
  const RetimedMotion retimed = retime(path, kWithJerk, where, {.mode = RetimingMode::blend});
  EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact);
  EXPECT_EQ(retimed.mode, RetimingMode::stop);
  EXPECT_EQ(retimed.shortened, 0u);
}

}  // namespace
}  // namespace firstcontact::test
