// A contact loop that is slow, or stalls: the force loop goes on.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/force_loop.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// A handle at the height z at a tick.
DeviceState handle_at(double z, const HapticSession& session, int tick) {
  DeviceState state;
  state.X_DH.position.z() = z;
  state.status = DeviceStatus::live;
  state.time_ns = session.time_ns();
  state.sequence = static_cast<std::uint64_t>(tick) + 1;
  return state;
}

bool has(const ForceTick& tick, ForceFault fault) {
  return (tick.tools[0].faults & static_cast<std::uint32_t>(fault)) != 0;
}

// Cycles of 20 ms in place of 1 ms. Each tick has the force of the set that it has at that moment,
// by a second force loop. On a floor this is the force of the spring, as without the delay.
TEST(SlowContactLoop, LeavesTicksAsTheyAre) {
  HapticSessionOptions slow;
  slow.contact_latency_ns = 20'000'000;
  slow.forces.limits.ramp_ns = 0;
  HapticSession session(cube_on_floor(), slow);
  ForceLoop again(session.contacts().scene(), complete_mappings(session.contacts().scene(), {}),
                  slow.forces);
  std::int64_t oldest = 0;
  std::uint64_t sets = 0;
  std::uint64_t last_set = 0;
  int felt = 0;
  for (int k = 0; k < 4000; ++k) {
    const double z = -0.012 + 1e-3 * std::sin(0.02 * k);
    const std::array states{handle_at(z, session, k)};
    const ForceTick& tick = session.step(states);
    ASSERT_EQ(tick.time_ns, 250'000 * std::int64_t{k});  // No tick is left out or late.
    ASSERT_EQ(tick.set, session.contact_set().sequence);
    const ForceTick& expected = again.tick(tick.time_ns, session.contact_set(), states);
    ASSERT_EQ(tick.tools[0].command.force_D, expected.tools[0].command.force_D) << k;
    ASSERT_EQ(tick.tools[0].command.torque_D, expected.tools[0].command.torque_D) << k;
    ASSERT_FALSE(has(tick, ForceFault::stale)) << k;
    oldest = std::max(oldest, tick.age_ns);
    sets += tick.set != last_set ? 1U : 0U;
    last_set = tick.set;
    if (tick.pressing > 0 && !has(tick, ForceFault::slewed)) {
      ++felt;
      const double stretch = -0.01 - z;  // The cube starts 1 cm above the floor.
      ASSERT_NEAR(tick.tools[0].command.force_D.z(), 1000.0 * stretch, 0.02) << k;
    }
  }
  EXPECT_GE(felt, 3800);
  EXPECT_GE(oldest, 39'000'000);
  EXPECT_LE(oldest, 40'000'000);
  EXPECT_EQ(sets, 50U);
}

// One stall while the handle presses and moves. The force is bounded. It is full while the set is
// fresh, and 0 once it is stale. It returns within the slew, and by the ramp.
TEST(StalledContactLoop, ForceDecaysAndReturnsWithoutAKick) {
  for (const std::int64_t stall_ms : {5, 50, 500}) {
    HapticSessionOptions options;
    options.forces.limits.force_slew = 2000.0;  // [N/s]  0.5 N a tick.
    HapticSession session(cube_on_floor(), options);
    const HapticLimits& limits = options.forces.limits;
    const double most_change = 2000.0 * 2.5e-4;
    Vector3d last = Vector3d::Zero();
    double greatest_change_after = 0.0;
    std::int64_t oldest = 0;
    double least = 1e9;
    for (int k = 0; k < 8000; ++k) {
      if (k == 2000) {
        session.stall_contacts(1'000'000 * stall_ms);
      }
      const double z = -0.012 + 1e-3 * std::sin(0.004 * k);
      const ForceTick& tick = session.step(std::array{handle_at(z, session, k)});
      const Vector3d& force = tick.tools[0].command.force_D;
      const double change = (force - last).norm();
      ASSERT_LE(change, most_change + 1e-9) << stall_ms << ", " << k;
      ASSERT_LE(force.norm(), 3.05) << stall_ms << ", " << k;  // The spring's, as without a stall.
      ASSERT_GE(force.z(), 0.0) << stall_ms << ", " << k;
      oldest = std::max(oldest, tick.age_ns);
      ASSERT_EQ(has(tick, ForceFault::stale), tick.age_ns > limits.fresh_ns);
      if (tick.age_ns >= limits.stale_ns) {
        ASSERT_EQ(force, Vector3d::Zero()) << stall_ms << ", " << k;
      }
      if (k >= 1500 && tick.age_ns <= limits.fresh_ns && !has(tick, ForceFault::ramping)) {
        ASSERT_NEAR(force.z(), 1000.0 * (-0.01 - z), 0.02) << stall_ms << ", " << k;
      }
      if (k >= 2000) {
        least = std::min(least, force.norm());
        // The decay of 100 ms takes 0.25 % a tick, the ramp of 200 ms half of that.
        greatest_change_after = std::max(greatest_change_after, change);
      }
      last = force;
    }
    EXPECT_NEAR(static_cast<double>(oldest), 1e6 * static_cast<double>(stall_ms) + 1.5e6, 1.5e6);
    EXPECT_LE(greatest_change_after, 0.015) << stall_ms;
    if (stall_ms > 150) {
      EXPECT_EQ(least, 0.0);
    } else {
      EXPECT_GE(least, 0.5) << stall_ms;
    }
    EXPECT_NEAR(last.z(), 1000.0 * (0.002 - 1e-3 * std::sin(0.004 * 7999)), 0.02) << stall_ms;
  }
}

TEST(StalledContactLoop, StallsForTenSecondsAtMost) {
  HapticSession session(cube_on_floor(), {});
  EXPECT_THROW(session.stall_contacts(-1), std::invalid_argument);
  EXPECT_THROW(session.stall_contacts(10'000'000'001), std::invalid_argument);
  EXPECT_NO_THROW(session.stall_contacts(10'000'000'000));
}

}  // namespace
}  // namespace firstcontact
