// The advance beside a triangle that deforms: whatever drift and bend allow, no corner is late.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/advance_deforming.h>
#include <firstcontact/narrowphase/triangle_distance.h>

#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

Triangle triangle_near(Random& random, const Vector3d& middle) {
  return {middle + random.vector(0.0, 1.0), middle + random.vector(0.0, 1.0),
          middle + random.vector(0.0, 1.0)};
}

/// A pair of which A deforms, and B turns, drifts and bends.
struct Case {
  RelativeState state;
  TrianglePair pair;
  TrianglePair rates;
  Vector3d n;
  ClosestFeatures closest;

  explicit Case(Random& random) {
    pair.A = triangle_near(random, Vector3d::Zero());
    pair.B = triangle_near(random, Vector3d(3.0, 0.0, 0.0) + random.vector(0.0, 0.5));
    const auto rate = [&] { return random.chance(0.3) ? Vector3d(0, 0, 0) : random.vector(0, 2); };
    rates.A = {rate(), rate(), rate()};
    rates.B = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    state.p_AB = Vector3d(3.0, 0.0, 0.0);
    state.p_AQa = random.vector(0.0, 1.0);
    state.p_AQb = state.p_AB + random.vector(0.0, 2.0);
    state.pivot_velocity = random.vector(0.0, 2.0);
    if (random.chance(0.7)) {
      state.axis_B = random.direction();
      state.rate_B = random.uniform(0.0, 3.0);
    }
    // One of the terms alone, or all.
    const int which = static_cast<int>(random.uniform(0.0, 5.0));
    const auto size = [&](int k) {
      return which == k || which == 4 ? random.uniform(0.5, 8.0) : 0.0;
    };
    state.drift = size(0);
    state.bend = size(1);
    state.bend_A = size(2);
    state.bend_B = size(3);
    closest = triangle_distance(pair.A, pair.B);
    n = (closest.p_B - closest.p_A).normalized();
  }

  /// Where the triangles are at worst: each corner as far along n as drift and bend take it.
  [[nodiscard]] TrianglePair after(double tau) const {
    TrianglePair moved = pair;
    const Eigen::AngleAxisd turn(state.rate_B * tau,
                                 state.rate_B > 0.0 ? state.axis_B : Vector3d(1.0, 0.0, 0.0));
    const double half = 0.5 * tau * tau;
    for (std::size_t k = 0; k < 3; ++k) {
      const double from_A = (pair.A[k] - state.p_AQa).norm();
      const double from_B = (pair.B[k] - state.p_AQb).norm();
      moved.A[k] += tau * rates.A[k] + half * state.bend_A * from_A * n;
      moved.B[k] = state.p_AQb + tau * state.pivot_velocity + turn * (pair.B[k] - state.p_AQb) -
                   (tau * state.drift + half * (state.bend + state.bend_B * from_B)) * n;
    }
    return moved;
  }
};

TEST(AdvanceDeforming, HoldsForAllThatDriftAndBendAllow) {
  constexpr double kThreshold = 0.05;
  int advanced = 0;
  double used = 0.0;  // Used part of the gap, on average.
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const Case c(random);
    if (!(c.closest.distance > 4.0 * kThreshold)) {
      continue;
    }
    const double tau = std::min(
        1.0, advance_deforming(c.state, c.pair, c.rates, c.closest, c.n, kThreshold, 1e-12, 1.0));
    if (!(tau > 0.0)) {
      continue;
    }
    ++advanced;
    double least = c.closest.distance;
    for (int k = 1; k <= 40; ++k) {
      const TrianglePair moved = c.after(tau * k / 40.0);
      least = std::min(least, triangle_distance(moved.A, moved.B).distance);
      ASSERT_GT(least, kThreshold) << seed << " at " << k << " of " << tau;
    }
    used += (c.closest.distance - least) / (c.closest.distance - kThreshold);
  }
  EXPECT_GT(advanced, 2000);
  EXPECT_GT(used / advanced, 0.5);  // Else a bound that is missing would not be missed.
}

}  // namespace
}  // namespace firstcontact::test
