// A peg that is wedged in its hole, and pressed hard: nothing runs away.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptic_sessions/haptic_session.h>

#include "haptics/haptic_scenes.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// [m]  How far a corner of the peg of peg_over_hole() is in a wall; below 0 outside. By its eight
/// corners alone: they are what touches the walls of the hole from within.
double depth_in_walls(const Pose& peg, double clearance) {
  const double inner = 0.01 + clearance;
  double deepest = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p_B((corner & 1) != 0 ? 0.01 : -0.01, (corner & 2) != 0 ? 0.01 : -0.01,
                       (corner & 4) != 0 ? 0.025 : -0.025);
    const Vector3d p_W = peg.position + peg.rotation * p_B;
    if (p_W.z() < 0.0) {
      deepest = std::max(
          {deepest, std::abs(p_W.x()) - inner, std::abs(p_W.y()) - inner, -0.0601 - p_W.z()});
    }
  }
  return deepest;
}

/// Whether two contacts face each other.
bool is_between_two_sides(const HapticContactSet& set) {
  for (std::uint32_t a = 0; a < set.count; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      if (set.contacts[a].normal.dot(set.contacts[b].normal) < -0.95) {
        return true;
      }
    }
  }
  return false;
}

struct Jam {
  double friction = 0.0;             // [-]
  Vector3d push = Vector3d::Zero();  // [m]    Beyond the place in the hole.
  Vector3d turn = Vector3d::Zero();  // [rad]
};

// The hand puts the peg halfway into the hole, turns it until both sides hold it, and presses on.
TEST(WedgedPeg, IsHeldByBothSidesWithBoundedForceAndWork) {
  constexpr double kClearance = 1e-4;
  for (const Jam& jam :
       {Jam{0.0, {0.0, 0.0, -0.05}, {0.3, 0.0, 0.0}}, Jam{0.6, {0.0, 0.0, -0.05}, {0.3, 0.0, 0.0}},
        Jam{0.6, {0.0, 0.0, -0.05}, {0.3, 0.2, 0.0}},
        Jam{0.3, {0.0, 0.05, -0.01}, {-0.4, 0.0, 0.0}}}) {
    HapticSession session(peg_over_hole(kClearance, jam.friction));
    const HapticLimits limits;
    const std::size_t most_rounds = ContactLoopOptions{}.rounds;
    bool both_sides = false;
    std::size_t rounds = 0;  // At rest.
    std::size_t cycles = 0;
    double greatest = 0.0;  // [-]  Force or torque, by its limit.
    const int ticks = 4 * test::rounds(1600, 1000);
    for (int k = 0; k < ticks; ++k) {
      // Into the hole in 0.3 s, then the turn and the push in 0.1 s.
      const double into = std::min(1.0, k / 1200.0);
      const double jammed = std::clamp((k - 1600) / 400.0, 0.0, 1.0);
      DeviceState state;
      state.X_DH.position = Vector3d(0.0, 0.0, -0.045 * into) + jammed * jam.push;
      const double angle = jammed * jam.turn.norm();
      state.X_DH.rotation = Eigen::AngleAxisd(angle, jam.turn.normalized());
      state.status = DeviceStatus::live;
      state.time_ns = session.time_ns();
      state.sequence = static_cast<std::uint64_t>(k) + 1;
      const ForceTick& tick = session.step(std::array{state});
      ASSERT_LE(tick.tools[0].force_W.norm(), limits.force * (1.0 + 1e-12)) << k;
      ASSERT_LE(tick.tools[0].torque_W.norm(), limits.torque * (1.0 + 1e-12)) << k;
      greatest = std::max({greatest, tick.tools[0].force_W.norm() / limits.force,
                           tick.tools[0].torque_W.norm() / limits.torque});
      ASSERT_LE(tick.pivots, 65U) << k;  // A search that gives up counts one more.
      if (const HapticCycle* cycle = session.cycle()) {
        ASSERT_GT(cycle->clearance, 0.0) << k;
        ASSERT_LE(cycle->rounds, most_rounds) << k;
        ASSERT_LT(depth_in_walls(session.contacts().pose(0), kClearance), 0.0) << k;
        rounds += k >= 2400 ? cycle->rounds : 0;
        cycles += k >= 2400 ? 1 : 0;
      }
      both_sides = is_between_two_sides(session.contact_set());  // At the end, too.
    }
    EXPECT_TRUE(both_sides) << jam.turn.transpose();
    EXPECT_NEAR(greatest, 1.0, 1e-9) << jam.turn.transpose();  // It is pressed to the limit.
    EXPECT_LE(rounds, 2 * cycles);                             // At rest a cycle ends early.
  }
}

}  // namespace
}  // namespace firstcontact
