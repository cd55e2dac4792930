// The certified advance, where the time is known in closed form.

#include <gtest/gtest.h>

#include <cmath>

#include <firstcontact/narrowphase/advance.h>

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

class AdvanceBy : public testing::TestWithParam<Closing> {};

/// A gap closes by the speed of the pivots, and by all that the motion may depart from its model.
TEST_P(AdvanceBy, TakesAllThatClosesTheGap) {
  const auto& [speed, drift, bend] = GetParam();
  RelativeState state;
  state.pivot_velocity = {0.0, 0.0, -speed};
  state.drift = drift;
  state.bend = bend;
  const double touch = time_for(kGap - kThreshold, speed + drift, bend);
  const double tau = advance_along_z(state, 100.0);
  EXPECT_LE(tau, touch);
  EXPECT_GE(tau, touch * (1.0 - 1e-9));
}

INSTANTIATE_TEST_SUITE_P(All, AdvanceBy,
                         testing::Values(Closing{1.0, 0.0, 0.0}, Closing{0.0, 1.0, 0.0},
                                         Closing{0.0, 0.0, 1.0}, Closing{0.5, 0.25, 2.0}));

TEST(Advance, CoversTheRestWhereNothingCloses) {
  RelativeState state;
  EXPECT_GT(advance_along_z(state, 1.0), 1.0);
  state.pivot_velocity = {3.0, 0.0, 0.5};  // Aside, and apart.
  EXPECT_GT(advance_along_z(state, 1.0), 1.0);
}

TEST(Advance, ProvesNothingOfNaN) {
  RelativeState state;
  state.bend = std::nan("");
  EXPECT_FALSE(advance_along_z(state, 1.0) > 0.0);
  state.bend = 0.0;
  state.drift = std::nan("");
  EXPECT_FALSE(advance_along_z(state, 1.0) > 0.0);
}

}  // namespace
}  // namespace firstcontact
