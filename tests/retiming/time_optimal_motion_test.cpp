// Nearly time-optimal motion: within limits, on the geometry, against a fine grid of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/time_optimal_motion.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

/// A point of the geometry: the blended path by a parameter of its own on each piece.
struct Sample {
  std::vector<double> d1;  // By the piece's parameter.
  std::vector<double> d2;
  std::vector<double> end_d1;  // At the end of the cell.
  std::vector<double> end_d2;
  double cell = 0.0;  // To the next sample.
  double join = 1.0;  // The square of the rate is multiplied by this here: another parameter.
};

/// One straight part or blend, in [0, 1] of its own parameter.
void add_piece(std::vector<Sample>& samples, const std::vector<double>& in,
               const std::vector<double>& turn, double join, int cells) {
  for (int k = 0; k < cells; ++k) {
    const double s = static_cast<double>(k) / cells;
    const double e = static_cast<double>(k + 1) / cells;
    Sample sample{{}, {}, {}, {}, 1.0 / cells, k == 0 ? join : 1.0};
    for (std::size_t j = 0; j < in.size(); ++j) {
      sample.d1.push_back(in[j] + 2.0 * turn[j] * s * s * (3.0 - 2.0 * s));
      sample.d2.push_back(12.0 * turn[j] * s * (1.0 - s));
      sample.end_d1.push_back(in[j] + 2.0 * turn[j] * e * e * (3.0 - 2.0 * e));
      sample.end_d2.push_back(12.0 * turn[j] * e * (1.0 - e));
    }
    samples.push_back(sample);
  }
}

/// The accelerations that are allowed with a square of the rate; none where lower > upper.
struct Allowed {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

Allowed allowed(const Sample& sample, double z, const std::vector<RateLimits>& limits) {
  Allowed u;
  const auto limit = [&u](double slope, double bend, double most) {
    if (std::abs(slope) < 1e-12) {
      u = std::abs(bend) > most ? Allowed{1.0, -1.0} : u;
      return;
    }
    const double a = (-most - bend) / slope;
    const double b = (most - bend) / slope;
    u.lower = std::max(u.lower, std::min(a, b));
    u.upper = std::min(u.upper, std::max(a, b));
  };
  for (std::size_t j = 0; j < limits.size(); ++j) {
    if (sample.d1[j] * sample.d1[j] * z > limits[j].velocity * limits[j].velocity) {
      return {1.0, -1.0};
    }
    limit(sample.d1[j], sample.d2[j] * z, limits[j].acceleration);
    // At the end of the cell z is z + 2 cell u.
    limit(sample.end_d1[j] + 2.0 * sample.cell * sample.end_d2[j], sample.end_d2[j] * z,
          limits[j].acceleration);
  }
  return u;
}

/// [s]  The least time along the geometry with limits of velocity and acceleration, whatever the
/// jerk: what is controllable backward, the fastest of it forward, on a fine grid.
double least_seconds(const WaypointPath& path, const std::vector<Blend>& blends,
                     const std::vector<RateLimits>& limits) {
  constexpr int kCells = 400;
  std::vector<Sample> samples;
  const std::size_t joints = limits.size();
  const auto scaled_way = [&](std::size_t edge, double factor) {
    std::vector<double> way(joints);
    for (std::size_t j = 0; j < joints; ++j) {
      way[j] = factor * (path.waypoints[edge + 1][j] - path.waypoints[edge][j]);
    }
    return way;
  };
  double sum = 0.0;
  double begin = 0.0;
  double join = 1.0;
  const auto solve = [&] {
    std::vector<double> reach(samples.size() + 1, 0.0);
    for (std::size_t i = samples.size(); i-- > 0;) {
      const double next = i + 1 < samples.size() ? reach[i + 1] / samples[i + 1].join : 0.0;
      double low = 0.0;
      double high = 1e6;
      for (int k = 0; k < 70; ++k) {
        const double z = 0.5 * (low + high);
        const Allowed u = allowed(samples[i], z, limits);
        const double lower = std::max(u.lower, -z / (2.0 * samples[i].cell));
        (lower <= u.upper && z + 2.0 * samples[i].cell * lower <= next ? low : high) = z;
      }
      reach[i] = low;
    }
    double z = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double most = i + 1 < samples.size() ? reach[i + 1] / samples[i + 1].join : 0.0;
      const Allowed u = allowed(samples[i], z, limits);
      const double next = std::clamp(z + 2.0 * samples[i].cell * u.upper, 0.0, most);
      sum += 2.0 * samples[i].cell / (std::sqrt(z) + std::sqrt(next) + 1e-15);
      z = i + 1 < samples.size() ? next * samples[i + 1].join : next;
    }
    samples.clear();
  };
  for (std::size_t edge = 0; edge + 1 < path.waypoints.size(); ++edge) {
    const bool is_last = edge + 2 == path.waypoints.size();
    const Blend blend = is_last ? Blend{} : blends[edge];
    const double straight = 1.0 - blend.before - begin;
    // dp/ds meets where ds of this piece over ds of the last one is the ratio of their lengths.
    add_piece(samples, scaled_way(edge, straight), std::vector<double>(joints, 0.0),
              edge == 0 || begin == 0.0 ? 1.0 : std::pow(join / straight, 2), kCells);
    if (blend.before > 0.0) {
      const std::vector<double> in = scaled_way(edge, blend.before);
      const std::vector<double> out = scaled_way(edge + 1, blend.after);
      std::vector<double> turn(joints);
      std::vector<double> twice(joints);
      for (std::size_t j = 0; j < joints; ++j) {
        turn[j] = out[j] - in[j];
        twice[j] = 2.0 * in[j];
      }
      add_piece(samples, twice, turn, std::pow(straight / (2.0 * blend.before), 2), kCells);
      join = 2.0 * blend.after;
      begin = blend.after;
    } else {
      solve();
      begin = 0.0;
    }
  }
  return sum;
}

struct Ratios {
  double greatest = 0.0;
  double mean = 0.0;
};

Ratios ratios(bool has_jerk, unsigned seed) {
  constexpr int kRounds = 8;
  std::mt19937 rng(seed);
  Ratios ratios;
  for (int round = 0; round < kRounds; ++round) {
    const WaypointPath path = random_path(rng, 6, 5, 1.5);
    const std::vector<RateLimits> limits = random_limits(rng, 6, has_jerk);
    const BlendedMotion blended =
        blend_motion(path, limits, std::vector<double>(3, kLongestBlend), 1.0 - 1e-4);
    const BlendedMotion fast = time_optimal_motion(blended, path, limits, 1.0 - 1e-4);
    const auto beyond = rate_beyond_limit(rate_report(fast.motion, limits));
    EXPECT_FALSE(beyond.has_value()) << round << ": " << describe(*beyond, "joint", false);
    EXPECT_LE(fast.motion.duration(), blended.motion.duration()) << round;
    const double least = least_seconds(path, fast.blends, limits);
    EXPECT_GE(fast.motion.duration(), 0.995 * least) << round;
    const double ratio = fast.motion.duration() / least;
    ratios.greatest = std::max(ratios.greatest, ratio);
    ratios.mean += ratio / kRounds;
  }
  return ratios;
}

TEST(TimeOptimalMotion, IsNearlyAsFastAsTheFineGridWithoutJerkLimits) {
  const Ratios found = ratios(false, 31);
  EXPECT_LE(found.greatest, 1.15);
  RecordProperty("greatest", std::to_string(found.greatest));
  RecordProperty("mean", std::to_string(found.mean));
}

// The grid knows no jerk: with jerk limits no motion need come near it.
TEST(TimeOptimalMotion, HoldsJerkLimits) {
  const Ratios found = ratios(true, 32);
  EXPECT_LE(found.greatest, 1.5);
  RecordProperty("greatest", std::to_string(found.greatest));
  RecordProperty("mean", std::to_string(found.mean));
}

// With a hundredth of the velocity and 1e-4 of the acceleration all takes a hundred times as long.
TEST(TimeOptimalMotion, HasAsManyPointsHoweverSlowItIs) {
  std::mt19937 rng(3);
  const WaypointPath path = random_path(rng, 3, 4, 1.0);
  const std::vector<RateLimits> fast = random_limits(rng, 3, false);
  std::vector<RateLimits> slow = fast;
  for (RateLimits& limit : slow) {
    limit.velocity *= 1e-2;
    limit.acceleration *= 1e-4;
  }
  const auto motion = [&](const std::vector<RateLimits>& limits) {
    const std::vector<double> longest(path.waypoints.size() - 2, kLongestBlend);
    return time_optimal_motion(blend_motion(path, limits, longest), path, limits).motion;
  };
  const TimedMotion quick = motion(fast);
  const TimedMotion long_one = motion(slow);
  EXPECT_GT(long_one.duration(), 90.0 * quick.duration());
  EXPECT_LT(long_one.duration(), 101.0 * quick.duration());
  EXPECT_LE(long_one.points.size(), 1100u * (path.waypoints.size() - 1));
}

// A straight edge is the closed form: the grid agrees with it.
TEST(TimeOptimalMotion, TheGridOfTheTestIsRight) {
  const WaypointPath path{{"j0"}, {{0.0}, {4.0}}};
  EXPECT_NEAR(least_seconds(path, {}, {{2.0, 2.0, std::nullopt}}), 3.0, 0.01);
}

}  // namespace
}  // namespace firstcontact::test
