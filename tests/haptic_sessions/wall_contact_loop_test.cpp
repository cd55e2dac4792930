// A contact loop on the wall clock that is slow: the force loop does not wait for it.

#include <algorithm>
#include <cstdint>
#include <stop_token>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/wall_session.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

/// A hand that rests where the device begins.
SimulatedOperator resting_hand() { return SimulatedOperator(SimulatedOperatorOptions{}); }

// Cycles take 20 ms more. A force loop that waited for them would feel each set once. The session
// runs until ten ticks in succession have felt one set: on a slow machine that takes longer.
TEST(WallSession, TicksDoNotWaitForASlowContactLoop) {
  constexpr std::int64_t kDelay = 20'000'000;
  SimulatedOperator hand = resting_hand();
  Device* const devices[] = {&hand};
  std::stop_source stop;
  std::uint64_t first = 0;  // The set of the start.
  std::uint64_t set = 0;
  int felt = 0;
  int most = 0;
  const std::int64_t begin = steady_now_ns();
  const WallSessionReport report = run_wall_session(
      cube_on_floor(), {.force_rate = 2000.0, .contact_rate = 500.0}, devices,
      {.duration = 60.0, .real_time = false, .empty_duration = 0.0, .contact_delay_ns = kDelay},
      [&](const ForceTick& tick) {
        first = first == 0 ? tick.set : first;
        felt = tick.set == set ? felt + 1 : 1;
        set = tick.set;
        most = set != first ? std::max(most, felt) : 0;
        if (most >= 10) {
          stop.request_stop();
        }
      },
      {}, stop.get_token());
  EXPECT_GE(most, 10);
  EXPECT_GE(report.ticks, 10U);
  EXPECT_LE(kDelay * static_cast<std::int64_t>(report.cycles), steady_now_ns() - begin);
}

// The same session with and without the delay: every tick is made, or counted as skipped.
TEST(WallSession, CountsAsManyTicksBesideASlowContactLoop) {
  for (const std::int64_t delay_ns : {0, 20'000'000}) {
    SimulatedOperator hand = resting_hand();
    Device* const devices[] = {&hand};
    std::int64_t oldest = 0;
    const WallSessionReport report = run_wall_session(
        cube_on_floor(), {.force_rate = 500.0, .contact_rate = 500.0}, devices,
        {.duration = 0.3, .real_time = false, .empty_duration = 0.0, .contact_delay_ns = delay_ns},
        [&](const ForceTick& tick) { oldest = std::max(oldest, tick.age_ns); });
    EXPECT_GE(report.ticks + report.skipped_ticks, 149U) << delay_ns;
    EXPECT_EQ(report.tick_delay.count(), report.ticks) << delay_ns;
    EXPECT_GE(oldest, delay_ns) << delay_ns;
  }
}

}  // namespace
}  // namespace firstcontact
