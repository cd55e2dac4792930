// Data that both loops share: run under the thread sanitizer.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptic_sessions/detail/tick_ring.h>
#include <firstcontact/haptic_sessions/wall_session.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/motion/motion.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

/// A set that differs everywhere from the one before.
void fill(std::uint64_t sequence, HapticContactSet& set) {
  set.sequence = sequence;
  set.stamp_ns = static_cast<std::int64_t>(3 * sequence);
  set.tools = 1;
  set.count = static_cast<std::uint32_t>(sequence % (kMostHapticContacts + 1));
  set.p_WC[0].setConstant(static_cast<double>(sequence));
  for (std::size_t k = 0; k < set.count; ++k) {
    set.contacts[k].point.setConstant(static_cast<double>(sequence + k));
    set.contacts[k].gap = static_cast<double>(sequence);
  }
  set.checksum = checksum_of(set);
}

TEST(HandOver, NeverGivesATornOrAnOlderSet) {
  constexpr std::uint64_t kSets = 20'000;
  MailSlot<HapticContactSet> slot;
  std::thread producer([&slot] {
    HapticContactSet set;
    for (std::uint64_t k = 1; k <= kSets; ++k) {
      fill(k, set);
      slot.put(set);
    }
  });
  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t older = 0;
  while (last < kSets) {
    const HapticContactSet& set = slot.newest();
    torn += set.sequence > 0 && set.checksum != checksum_of(set) ? 1U : 0U;
    older += set.sequence < last ? 1U : 0U;
    last = set.sequence;
  }
  producer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(older, 0U);
}

TEST(HandOver, ChecksumTellsATornSet) {
  HapticContactSet set;
  fill(77, set);
  set.contacts[50].point.x() += 1e-9;
  EXPECT_NE(set.checksum, checksum_of(set));
}

TEST(TickRing, KeepsTheOrderAndCountsWhatItDrops) {
  detail::TickRing<int> ring(8);
  std::atomic<bool> is_done{false};
  constexpr int kItems = 20'000;
  std::thread producer([&] {
    for (int k = 0; k < kItems; ++k) {
      ring.push(k);
    }
    is_done = true;
  });
  int taken = 0;
  int last = -1;
  int item = 0;
  bool in_order = true;
  bool goes_on = true;
  while (goes_on) {
    goes_on = !is_done;
    while (ring.pop(item)) {
      in_order = in_order && item > last;
      last = item;
      ++taken;
    }
  }
  producer.join();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(static_cast<std::uint64_t>(taken) + ring.dropped(), std::uint64_t{kItems});
}

/// A handle that is pressed into the floor.
class StillDevice : public Device {
 public:
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override {
    DeviceState state;
    state.X_DH.position = {0.0, 0.0, -0.012};
    state.time_ns = now_ns;
    state.sequence = ++sequence_;
    state.status = DeviceStatus::live;
    return state;
  }
  void command(const ForceCommand& command, std::int64_t /*now_ns*/) noexcept override {
    last_ = command;
  }
  [[nodiscard]] DeviceCounts counts() const override { return {}; }
  [[nodiscard]] std::string problem() const override { return {}; }

  [[nodiscard]] const ForceCommand& last() const { return last_; }

 private:
  DeviceCapabilities capabilities_;
  std::uint64_t sequence_ = 0;
  ForceCommand last_;
};

/// A device whose reading is lost: finite, but nowhere.
class FarDevice : public StillDevice {
 public:
  DeviceState read(std::int64_t now_ns) noexcept override {
    DeviceState state = StillDevice::read(now_ns);
    state.X_DH.position.x() = 1e70;
    return state;
  }
};

TEST(WallSession, DoesNotFollowADeviceThatIsNowhere) {
  FarDevice device;
  Device* const devices[] = {&device};
  std::uint32_t faults = 0;
  double farthest = 0.0;
  (void)run_wall_session(
      cube_on_floor(), {.force_rate = 500.0, .contact_rate = 100.0}, devices,
      {.duration = 0.1, .real_time = false},
      [&](const ForceTick& tick) { faults |= tick.tools[0].faults; },
      [&](const HapticCycle& cycle, std::int64_t) {
        farthest = std::max(farthest, cycle.members[0].X_WB.position.norm());
      });
  EXPECT_NE(faults & static_cast<std::uint32_t>(ForceFault::not_finite), 0U);
  EXPECT_LT(farthest, 1.0);
}

/// A device that drives 0.5 N.
class WeakDevice : public StillDevice {
 public:
  WeakDevice() {
    weak_.driven = DegreesOfFreedom::translation();
    weak_.max_force = 0.5;
  }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return weak_; }

 private:
  DeviceCapabilities weak_ = StillDevice::capabilities();
};

TEST(WallSession, LogsTheForceThatTheDeviceCanDrive) {
  WeakDevice device;
  Device* const devices[] = {&device};
  double greatest = 0.0;
  std::uint32_t faults = 0;
  (void)run_wall_session(cube_on_floor(), {.force_rate = 500.0, .contact_rate = 100.0}, devices,
                         {.duration = 0.2, .real_time = false},
                         [&](const ForceTick& tick) {
                           greatest = std::max(greatest, tick.tools[0].command.force_D.norm());
                           faults |= tick.tools[0].faults;
                         },
                         {});
  EXPECT_NEAR(greatest, 0.5, 1e-12);
  EXPECT_NE(faults & static_cast<std::uint32_t>(ForceFault::limited), 0U);
}

TEST(WallSession, HandsOverEveryTickAndEveryCycle) {
  StillDevice device;
  Device* const devices[] = {&device};
  HapticSessionOptions options{.force_rate = 500.0, .contact_rate = 100.0};
  options.forces.limits.fresh_ns = 5'000'000'000;  // Longer than a busy machine needs.
  options.forces.limits.stale_ns = 6'000'000'000;
  std::uint64_t ticks = 0;
  std::array<std::uint64_t, kContactClasses> ticks_of{};
  std::uint64_t cycles = 0;
  std::uint64_t stale = 0;
  double greatest = 0.0;
  const WallSessionReport report = run_wall_session(
      cube_on_floor(), options, devices,
      {.duration = 0.1, .real_time = false, .empty_duration = 0.06},
      [&](const ForceTick& tick) {
        ++ticks;
        ++ticks_of[std::bit_width(tick.contacts)];
        EXPECT_GE(tick.age_ns, 0);
        stale +=
            (tick.tools[0].faults & static_cast<std::uint32_t>(ForceFault::stale)) != 0 ? 1 : 0;
        greatest = std::max(greatest, tick.tools[0].command.force_D.norm());
      },
      [&](const HapticCycle& cycle, std::int64_t) {
        ++cycles;
        EXPECT_GT(cycle.clearance, 0.0);
      });
  EXPECT_EQ(ticks, report.ticks);
  EXPECT_EQ(cycles, report.cycles);
  EXPECT_EQ(stale, 0U);  // Not even the first ticks, before a cycle is over.
  EXPECT_EQ(report.unread_ticks, 0U);
  EXPECT_EQ(report.behind_ns, 0);  // Nothing but the tool moves here.
  EXPECT_EQ(report.tick_cpu.count(), report.ticks);
  for (std::size_t k = 0; k < kContactClasses; ++k) {
    EXPECT_EQ(report.tick_cpu_by_contacts[k].count(), ticks_of[k]) << least_contacts(k);
  }
  EXPECT_EQ(report.empty_delay.count(), 30U);
  EXPECT_GE(report.ticks + report.skipped_ticks, 49U);
  EXPECT_EQ(device.last().force_D, Eigen::Vector3d::Zero());  // It is let go at the end.
}

// Cycles that are late by a multiple of their period: courses move on by one period each.
TEST(WallSession, CountsTheTimeByWhichCoursesAreBehind) {
  HapticScene scene = cube_on_floor();
  scene.bodies.push_back(body_at("mover", make_box({0.01, 0.01, 0.01}), {0.5, 0.5, 0.5}));
  scene.bodies.back().course =
      Motion::constant_velocity(scene.bodies.back().X_WB, Eigen::Vector3d(0.0, 0.0, 10.0));
  scene.duration = 10.0;
  StillDevice device;
  Device* const devices[] = {&device};
  double moved = 0.0;
  double asked = 0.0;
  double lasted = 0.0;
  const std::int64_t begin = steady_now_ns();
  const WallSessionReport report =
      run_wall_session(scene, {.force_rate = 500.0, .contact_rate = 500.0}, devices,
                       {.duration = 0.4, .real_time = false, .contact_delay_ns = 10'000'000}, {},
                       [&](const HapticCycle& cycle, std::int64_t) {
                         asked += cycle.asked;
                         lasted += cycle.lasted;
                         moved = cycle.members.back().X_WB.position.z() - 0.5;
                       });
  const double passed = 1e-9 * static_cast<double>(steady_now_ns() - begin);
  const double behind = 1e-9 * static_cast<double>(report.behind_ns);
  // Bounds that hold on a machine of any speed: a cycle begins 10 ms after the last one or later.
  ASSERT_GE(report.cycles, 2U);
  const auto later_cycles = static_cast<double>(report.cycles - 1);
  EXPECT_GE(behind, (0.01 - 0.002) * later_cycles);
  EXPECT_LE(behind, passed - 0.002 * later_cycles);
  EXPECT_NEAR(asked, 0.002 * (later_cycles + 1.0), 1e-9);
  EXPECT_LE(lasted, asked);  // Less where a slow machine could not prove a whole cycle in time.
  EXPECT_NEAR(moved, lasted, 1e-9);
}

/// An exception of a callback reaches the caller, long before the session would have ended. Both
/// threads have stopped, and the device is released.
TEST(WallSession, EndsWithWhatTheCallerThrows) {
  const HapticSessionOptions options{.force_rate = 500.0, .contact_rate = 100.0};
  const WallSessionOptions wall{.duration = 3600.0, .real_time = false};
  for (const bool in_cycle : {false, true}) {
    StillDevice device;
    Device* const devices[] = {&device};
    int calls = 0;
    const auto throw_at_third = [&] {
      if (++calls == 3) {
        throw std::runtime_error("the disk is full");
      }
    };
    const std::function<void(const ForceTick&)> on_tick = [&](const ForceTick&) {
      if (!in_cycle) {
        throw_at_third();
      }
    };
    const std::function<void(const HapticCycle&, std::int64_t)> on_cycle = [&](const HapticCycle&,
                                                                               std::int64_t) {
      if (in_cycle) {
        throw_at_third();
      }
    };
    EXPECT_THROW((void)run_wall_session(cube_on_floor(), options, devices, wall, on_tick, on_cycle),
                 std::runtime_error);
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(device.last().force_D, Eigen::Vector3d::Zero());
  }
}

}  // namespace
}  // namespace firstcontact
