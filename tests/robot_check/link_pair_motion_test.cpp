// Motion of two links as queries get it: poses, twists, and a bound of the departure. The departure
// is that of the exact motion from the model that extrapolates it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/robot_check/link_pair_motion.h>

#include "robot/chain_case.h"
#include "robot/planar_arm.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;
using oracle::Wide;

/// From t to t + tau, of a point of B that is at p from A's centre at t.
Vector3d model_displacement(const RelativeState& state, const Vector3d& p, double tau) {
  const Vector3d lever = p - state.p_AQb;
  const Eigen::AngleAxisd turn(state.rate_B * tau, state.axis_B.norm() > 0.0
                                                       ? Vector3d(state.axis_B.normalized())
                                                       : Vector3d(Vector3d::UnitX()));
  return tau * state.pivot_velocity + (turn * lever - lever);
}

struct Departure {
  double worst_excess = -1.0;  ///< [m]  Over the bound; below 0 where it holds.
  double share = 0.0;  ///< [-]  Greatest departure at the window's end, divided by the bound.
};

/// A random chain, seen from a resting body, over one window from its start and from its middle.
Departure departure(std::uint64_t seed) {
  Random random(seed + 5000);
  const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
  const LinkMotion tip = c.motion.link(c.motion.model().links().size() - 1);
  const LinkMotion rest(Motion::fixed());
  const LinkBall ball{tip, random.vector(0.0, 0.2), random.uniform(0.0, 0.3)};
  LinkScratch scratch;
  LinkPairMotion motion({rest, Vector3d::Zero(), 0.1}, ball, scratch);
  const double begin = random.uniform(0.0, 0.95);
  const double end = motion.enter(begin);
  Departure found;
  for (const double t : {begin, 0.5 * (begin + end)}) {
    const RelativeState state = motion.state(t);
    const auto chain = c.exact(t);
    for (int k = 0; k < 6; ++k) {
      const Vector3d e = (1.0 - 1e-15) * ball.radius * random.direction();
      const auto point = exact_point(ball.p_LC + e);
      const Vector3d p = state.p_AB + state.R_WB * e;
      const auto start = oracle::exact_place(chain, Wide(t), point);
      for (const double part : {0.01, 0.3, 1.0}) {
        const double tau = part * (end - t);
        const Vector3d model = model_displacement(state, p, tau);
        const auto exact = oracle::exact_place(chain, Wide(t + tau), point) - start;
        const double apart = norm(exact - exact_point(model)).nearest();
        const double bend = state.bend_of(0.0, (p - state.p_AQb).norm());
        const double most = state.drift * tau + 0.5 * bend * tau * tau;
        // Rounding errors of this test: the model's displacement, and t + tau.
        const double size = p.norm() + (p - state.p_AQb).norm() + ball.radius;
        const double rounding = 1e-15 * (size * (1.0 + state.rate_B) + model.norm());
        found.worst_excess = std::max(found.worst_excess, apart - most - rounding);
        found.share = std::max(found.share, part == 1.0 && most > 1e-9 ? apart / most : 0.0);
      }
    }
  }
  return found;
}

TEST(LinkPairMotion, NoPointDepartsFromTheModelByMoreThanSaid) {
  for (std::uint64_t seed = 0; seed < test::rounds(300, 60); ++seed) {
    ASSERT_LE(departure(seed).worst_excess, 0.0) << seed;
  }
}

/// The twin: a bound of infinity would pass the test above.
TEST(LinkPairMotion, SaysNotMuchMoreThanWhatPointsDepart) {
  double mean = 0.0;
  constexpr int kCases = test::rounds(100, 40);
  for (std::uint64_t seed = 0; seed < kCases; ++seed) {
    mean += departure(seed).share / kCases;
  }
  RecordProperty("mean_share", std::to_string(mean));
  EXPECT_GE(mean, 0.2);
}

/// One axle that turns steadily is its own model: at a window's end nothing is left to bend.
TEST(LinkPairMotion, ASteadyHingeHasNoBend) {
  constexpr double kRate = 3.0;
  constexpr double kArm = 2.0;
  constexpr double kRadius = 0.1;
  const RobotMotion robot = planar_motion({ramp(0.0, kRate)});
  const LinkMotion arm = robot.link(1);
  const LinkMotion rest(Motion::fixed());
  LinkScratch scratch;
  LinkPairMotion motion({rest, Vector3d::Zero(), kRadius}, {arm, {kArm, 0.0, 0.0}, kRadius},
                        scratch);
  const double end = motion.enter(0.0);
  const double steady = kRate * kRate * (kArm + kRadius);
  EXPECT_LE(motion.state(0.0).bend_of(0.0, kArm + kRadius), 0.7 * steady);
  EXPECT_LE(motion.state(end).bend_of(0.0, kArm + kRadius), 1e-9 * steady);
  EXPECT_LE(motion.state(0.0).drift, 1e-12);
  EXPECT_LE((motion.state(0.0).p_AQb).norm(), 1e-12);  // The pole is on the axle.
}

/// A point near the axle bends less.
TEST(LinkPairMotion, BendGrowsWithTheDistanceFromThePole) {
  const RobotMotion robot = planar_motion({ramp(0.0, 1.0), ramp(0.0, 0.5)});
  const LinkMotion arm = robot.link(2);
  const LinkMotion rest(Motion::fixed());
  LinkScratch scratch;
  LinkPairMotion motion({rest, Vector3d::Zero(), 0.1}, {arm, {0.5, 0.0, 0.0}, 1.0}, scratch);
  motion.enter(0.0);
  const RelativeState state = motion.state(0.0);
  EXPECT_GT(state.bend_B, 0.0);
  EXPECT_LE(state.bend_of(0.0, 0.1), 0.5 * state.bend_of(0.0, 1.0));
}

/// Bodies that follow a Motion are their own models for any number of turns.
TEST(LinkPairMotion, FreeBodiesHaveNoBend) {
  const Motion spin = Motion::constant_velocity({}, {1.0, 0.0, 0.0}, {0.0, 0.0, 6000.0});
  const LinkMotion A(spin);
  const LinkMotion B(Motion::fixed());
  LinkScratch scratch;
  LinkPairMotion motion({A, {0.1, 0.2, 0.3}, 0.5}, {B, Vector3d::Zero(), 0.5}, scratch);
  EXPECT_EQ(motion.enter(0.0), 1.0);
  EXPECT_EQ(motion.state(0.3).bend_of(1.0, 1.0), 0.0);
  EXPECT_LE(motion.state(0.3).drift, 1e-10);
}

/// A time at the very end of a piece, and one between windows, belong to some window.
TEST(LinkPairMotion, WindowsCoverTheStep) {
  const RobotMotion robot = planar_motion({ramp(0.0, 500.0)});
  const LinkMotion arm = robot.link(1);
  const LinkMotion rest(Motion::fixed());
  LinkScratch scratch;
  LinkPairMotion motion({rest, Vector3d::Zero(), 0.1}, {arm, {1.0, 0.0, 0.0}, 0.1}, scratch);
  double t = 0.0;
  int windows = 0;
  while (t < 1.0) {
    const double end = motion.enter(t);
    ASSERT_GT(end, t);
    t = end;
    ++windows;
  }
  EXPECT_EQ(t, 1.0);
  EXPECT_GE(windows, 100);
  EXPECT_LE(windows, 1100);
  EXPECT_EQ(motion.enter(1.0), 1.0);
}

}  // namespace
}  // namespace firstcontact::test
