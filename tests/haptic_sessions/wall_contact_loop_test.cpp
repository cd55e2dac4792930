// A contact loop on the wall clock that is slow: the force loop does not wait for it.

#include <algorithm>
#include <cstdint>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/wall_session.h>

#include "haptics/haptic_scenes.h"
#include "support/thread_mesh.h"

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

/// A threaded rod in its nut: a cycle looks at thousands of triangles that are near.
HapticScene rod_in_nut() {
  const test::Thread rod{.segments = 60, .turns = 6, .lead = 2e-3, .radius = 6e-3, .depth = 1e-3};
  test::Thread nut = rod;
  nut.wider = 1e-4;
  HapticScene scene;
  scene.tools.push_back(tool_at("rod", test::make_thread(rod), Eigen::Vector3d::Zero()));
  scene.bodies.push_back(body_at("nut", test::make_thread(nut), Eigen::Vector3d::Zero()));
  scene.contact_distance = 1e-6;
  return scene;
}

/// A hand that turns the rod to and fro, and presses it against the nut.
SimulatedOperator screwing_hand() {
  SimulatedOperatorOptions options;
  options.path.clear();
  for (int k = 0; k < 100; ++k) {
    ViaPoint point;
    point.time = 0.05 * k;
    point.X_DH.position = {k % 2 == 0 ? 5e-4 : -5e-4, k % 3 == 0 ? 5e-4 : 0.0, 0.0};
    point.X_DH.rotation = Eigen::AngleAxisd(0.1 * (k % 2), Eigen::Vector3d::UnitZ());
    options.path.push_back(point);
  }
  return SimulatedOperator(options);
}

// Linux stops a real-time thread that runs for more than 95 % of a second, so the thread of the
// contact loop rests for 1/16 of its time. Each cycle is longer than its period. The session is too
// short for Linux to stop the thread: without the rest it would run for 98 % of the time.
TEST(WallSession, ContactThreadLeavesAPartOfItsProcessor) {
  SimulatedOperator hand = screwing_hand();
  Device* const devices[] = {&hand};
  struct Cycle {
    double processor_time = 0.0;  // [s]
    std::int64_t stamp_ns = 0;    // Time of the tick that gave its targets.
  };
  std::vector<Cycle> cycles;
  std::vector<std::int64_t> ticks;  // [ns]
  const WallSessionReport report = run_wall_session(
      rod_in_nut(), {.force_rate = 4000.0, .contact_rate = 4000.0}, devices,
      {.duration = 0.8, .empty_duration = 0.0},
      [&](const ForceTick& tick) { ticks.push_back(tick.time_ns); },
      [&](const HapticCycle& cycle, std::int64_t stamp_ns) {
        ASSERT_TRUE(cycle.processor_time.has_value());
        cycles.push_back({*cycle.processor_time, stamp_ns});
      });
  ASSERT_EQ(cycles.size(), report.cycles);
  if (!report.granted.contact_fifo) {
    GTEST_SKIP() << "SCHED_FIFO is not granted here: the contact thread does not rest";
  }
  ASSERT_FALSE(ticks.empty());
  // A cycle takes the newest targets. So one whose targets are not those of the last tick began
  // before the last tick had ended, and all cycles before it had ended and rested.
  std::erase_if(cycles, [&](const Cycle& cycle) { return cycle.stamp_ns >= ticks.back(); });
  ASSERT_GE(cycles.size(), 1U);
  cycles.pop_back();
  double sum = 0.0;
  for (const Cycle& cycle : cycles) {
    sum += cycle.processor_time;
  }
  const double passed =
      1e-9 * static_cast<double>(ticks.back() - ticks.front() + report.tick_wall.greatest_ns());
  EXPECT_GE(sum, 2.5e-4 * static_cast<double>(cycles.size()));  // They are longer than a period.
  EXPECT_LE(sum, 16.0 / 17.0 * passed) << cycles.size();
  static_assert(16.0 / 17.0 < 0.95);
}

}  // namespace
}  // namespace firstcontact
