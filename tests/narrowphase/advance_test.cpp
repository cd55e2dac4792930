// The certified advance, for every instruction set that this processor has: where the time is known
// in closed form, and against samples of bodies that turn.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/triangle_distance.h>

#include "support/instruction_sets.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kGap = 0.5;
constexpr double kThreshold = 0.1;

/// Two parallel triangles, kGap apart along z.
TrianglePair parallel_pair() {
  const Triangle below{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  Triangle above = below;
  for (Vector3d& v : above) {
    v.z() = kGap;
  }
  return {below, above};
}

double advance_along_z(const RelativeState& state, double t_end) {
  return advance(state, parallel_pair(), Vector3d::UnitZ(), kThreshold, 0.0, t_end);
}

/// The first tau with way = speed tau + acceleration tau^2 / 2.
double time_for(double way, double speed, double acceleration) {
  return 2.0 * way / (speed + std::sqrt(speed * speed + 2.0 * acceleration * way));
}

struct Closing {
  double speed;
  double drift;
  double bend;
};

using AdvanceOn = test::OnInstructionSet;

/// A gap closes by the speed of the pivots, and by all that the motion may depart from its model.
TEST_P(AdvanceOn, TakesAllThatClosesTheGap) {
  for (const auto& [speed, drift, bend] : {Closing{1.0, 0.0, 0.0}, Closing{0.0, 1.0, 0.0},
                                           Closing{0.0, 0.0, 1.0}, Closing{0.5, 0.25, 2.0}}) {
    RelativeState state;
    state.pivot_velocity = {0.0, 0.0, -speed};
    state.drift = drift;
    state.bend = bend;
    const double touch = time_for(kGap - kThreshold, speed + drift, bend);
    const double tau = advance_along_z(state, 100.0);
    EXPECT_LE(tau, touch);
    EXPECT_GE(tau, touch * (1.0 - 1e-9));
  }
}

TEST_P(AdvanceOn, CoversTheRestWhereNothingCloses) {
  RelativeState state;
  EXPECT_GT(advance_along_z(state, 1.0), 1.0);
  state.pivot_velocity = {3.0, 0.0, 0.5};  // Aside, and apart.
  EXPECT_GT(advance_along_z(state, 1.0), 1.0);
}

TEST_P(AdvanceOn, ProvesNothingOfNaN) {
  RelativeState state;
  state.bend = std::nan("");
  EXPECT_FALSE(advance_along_z(state, 1.0) > 0.0);
  state.bend = 0.0;
  state.drift = std::nan("");
  EXPECT_FALSE(advance_along_z(state, 1.0) > 0.0);
}

Triangle random_triangle(test::Random& random, const Vector3d& about) {
  Triangle T;
  for (Vector3d& corner : T) {
    corner = about + random.vector(0.0, 0.3);
  }
  return T;
}

/// Bodies that turn about pivots beside them, apart by about 1.
RelativeState random_state(test::Random& random) {
  RelativeState state;
  state.p_AQa = random.vector(0.0, 0.5);
  state.p_AQb = Vector3d::UnitX() + random.vector(0.0, 0.5);
  state.axis_A = random.direction();
  state.axis_B = random.direction();
  state.rate_A = random.chance(0.2) ? 0.0 : random.logarithmic(0.01, 3.0);
  state.rate_B = random.chance(0.2) ? 0.0 : random.logarithmic(0.01, 3.0);
  state.pivot_velocity = random.vector(0.0, 2.0);
  return state;
}

Triangle turned(const Triangle& T, const Vector3d& pivot, const Vector3d& axis, double angle,
                const Vector3d& by) {
  const Eigen::AngleAxisd R(angle, axis);
  Triangle placed;
  for (std::size_t k = 0; k < 3; ++k) {
    placed[k] = pivot + by + R * (T[k] - pivot);
  }
  return placed;
}

double distance_after(const RelativeState& state, const TrianglePair& pair, double tau) {
  return triangle_distance(
             turned(pair.A, state.p_AQa, state.axis_A, state.rate_A * tau, Vector3d::Zero()),
             turned(pair.B, state.p_AQb, state.axis_B, state.rate_B * tau,
                    tau * state.pivot_velocity))
      .distance;
}

// Law: until the time that is proven, the triangles are farther apart than the threshold. Along the
// closest points' direction, by which they mostly come near, the time is sharp for most.
TEST_P(AdvanceOn, NeverReachesBeyondWhereTrianglesAreTooNear) {
  constexpr int kTrials = 2000;
  constexpr int kSamples = 16;
  test::Random random(7);
  int sharp = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RelativeState state = random_state(random);
    const TrianglePair pair{random_triangle(random, Vector3d::Zero()),
                            random_triangle(random, Vector3d::UnitX())};
    const ClosestFeatures closest = triangle_distance(pair.A, pair.B);
    ASSERT_GT(closest.distance, 0.0);
    const Vector3d n = (closest.p_B - closest.p_A) / closest.distance;
    state.pivot_velocity -= random.uniform(0.0, 4.0) * n;
    const double threshold = random.uniform(0.05, 0.95) * closest.distance;
    const double tau = std::min(advance(state, pair, n, threshold, 0.0, 1.0), 1.0);
    for (int k = 0; k <= kSamples; ++k) {
      EXPECT_GT(distance_after(state, pair, tau * k / kSamples), threshold * (1.0 - 1e-12))
          << trial;
    }
    sharp += tau == 1.0 || distance_after(state, pair, 1.25 * tau) < threshold ? 1 : 0;
  }
  EXPECT_GT(sharp, kTrials / 2);
}

/// A wide plate on the plane z = 0, about a pivot at its middle.
Triangle plate() { return {Vector3d(-3, -2, 0), Vector3d(3, -2, 0), Vector3d(0, 4, 0)}; }

/// How long a plate that turns about y, and takes the direction with it, is proven apart from a
/// point that moves at constant velocity.
double advance_from_plate(double rate, const Vector3d& point, const Vector3d& velocity) {
  RelativeState state;
  state.axis_A = -Vector3d::UnitY();  // The side of positive x rises.
  state.rate_A = rate;
  state.p_AQb = point;
  state.pivot_velocity = velocity;
  return advance(state, {plate(), {point, point, point}}, Vector3d::UnitZ(), 0.0, 0.0, 1.0);
}

// Over the plate a point moves aside, where the plate rises: only by the acceleration of Coriolis.
TEST_P(AdvanceOn, TakesTheAccelerationOfCoriolis) {
  const double height = 0.1;
  const double rate = 0.3;
  const double tau = advance_from_plate(rate, {0.0, 0.0, height}, Vector3d::UnitX());
  double touch = 0.0;  // There tau tan(rate tau) = height.
  for (double step = 0.5; step > 1e-15; step *= 0.5) {
    touch += (touch + step) * std::tan(rate * (touch + step)) < height ? step : 0.0;
  }
  EXPECT_LE(tau, touch);
  EXPECT_GE(tau, 0.9 * touch);
}

// A point stands still, and the plate's plane turns under it: it comes near by the acceleration of
// the turning frame.
TEST_P(AdvanceOn, TakesTheAccelerationOfTheTurningFrame) {
  const double rate = 2.0;
  const double height = 0.1;
  const double aside = 0.5;
  const double tau = advance_from_plate(rate, {aside, 0.0, height}, Vector3d::Zero());
  const double touch = std::atan2(height, aside) / rate;
  EXPECT_LE(tau, touch);
  EXPECT_GE(tau, 0.8 * touch);
}

INSTANTIATE_TEST_SUITE_P(, AdvanceOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact
