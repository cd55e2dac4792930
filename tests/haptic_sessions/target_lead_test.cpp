// Leads a target by its velocity, and not by anything else.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/detail/target_lead.h>
#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/haptics/detail/target_follower.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kTick = 250'000;  // [ns]
constexpr double kAhead = 1e-3;          // [s]

Pose moving(const Vector3d& velocity, const Vector3d& turning, double time) {
  return {time * velocity, turn_by(time * turning)};
}

/// Ticks of a device whose samples are the targets.
struct Ticks {
  explicit Ticks(const DeviceMapping& mapping = {}) : lead(mapping) {}

  void give(const Pose& target, std::uint32_t faults = 0, bool is_new = true) {
    tick.target = target;
    tick.centre = target.position;
    tick.faults = faults;
    if (is_new) {
      tick.device.time_ns = now;
      ++tick.device.sequence;
    }
    lead.watch(now, tick);
    now += kTick;
  }

  void give_at(double x, std::uint32_t faults = 0) {
    give({{x, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, faults);
  }

  void move(int count, double speed = 0.2) {
    for (int k = 0; k < count; ++k) {
      give_at(speed * time());
    }
  }

  [[nodiscard]] double time() const { return 1e-9 * static_cast<double>(now); }

  [[nodiscard]] bool leads() const {
    const Pose led = lead.target_in(kAhead);
    return led.position != tick.target.position ||
           led.rotation.coeffs() != tick.target.rotation.coeffs();
  }

  TargetLead lead;
  ToolTick tick;
  std::int64_t now = 0;
};

TEST(TargetLead, MeetsATargetAtConstantVelocity) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> normal;
  for (const int every : {1, 2, 4, 8}) {  // Samples at 4000 to 500 Hz.
    for (int trial = 0; trial < 50; ++trial) {
      const Vector3d velocity(normal(rng), normal(rng), normal(rng));
      const Vector3d turning = 3.0 * Vector3d(normal(rng), normal(rng), normal(rng));
      Ticks ticks;
      Pose last;
      for (int k = 0; k <= 40; ++k) {
        last = k % every == 0 ? moving(velocity, turning, ticks.time()) : last;
        ticks.give(last, 0, k % every == 0);
      }
      const Pose expected = moving(velocity, turning, ticks.time() - 1e-9 * kTick + kAhead);
      const Pose led = ticks.lead.target_in(kAhead);
      ASSERT_LE((led.position - expected.position).norm(), 1e-12) << every << " " << trial;
      ASSERT_LE(turn_between(led.rotation, expected.rotation).norm(), 1e-9) << every;
    }
  }
}

TEST(TargetLead, LeadsAStillTargetByNothing) {
  Ticks ticks;
  for (int k = 0; k < 100; ++k) {
    ticks.give_at(0.1);
    ASSERT_FALSE(ticks.leads()) << k;
  }
}

// Two steps of an encoder in turn have no velocity, whatever their order.
TEST(TargetLead, LeadsATremblingEncoderByNothing) {
  std::mt19937_64 rng(5);
  Ticks ticks;
  for (int k = 0; k < 4000; ++k) {
    ticks.give_at(rng() % 2 == 0 ? 0.0 : 1e-5);
    ASSERT_FALSE(ticks.leads()) << k;
  }
}

TEST(TargetLead, LeadsAJumpByNothing) {
  for (const double jump : {1e-3, 0.01, 1.0, 1e5}) {
    Ticks ticks;
    for (int k = 0; k < 100; ++k) {
      ticks.give_at(k < 50 ? 0.0 : jump);
      ASSERT_FALSE(ticks.leads()) << jump << " " << k;
    }
  }
}

// A jump in a motion: the lead is at most that of the motion.
TEST(TargetLead, LeadsNoFartherThanTheMotionBeforeAJump) {
  Ticks ticks;
  ticks.move(50);
  for (int k = 0; k < 50; ++k) {
    ticks.give_at(0.02 + 0.2 * ticks.time());
    const Pose led = ticks.lead.target_in(kAhead);
    ASSERT_LE((led.position - ticks.tick.target.position).norm(), 0.2 * kAhead * (1.0 + 1e-9));
  }
}

TEST(TargetLead, FasterThanAHandIsAJump) {
  Ticks fast;
  fast.move(100, 9.0);
  EXPECT_TRUE(fast.leads());
  Ticks too_fast;
  too_fast.move(100, 11.0);
  EXPECT_FALSE(too_fast.leads());
  Ticks infinite;
  infinite.move(100, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(infinite.leads());
}

TEST(TargetLead, BeginsAnewAfterFaultsAndTheClutch) {
  for (const ForceFault fault :
       {ForceFault::device, ForceFault::not_finite, ForceFault::disengaged}) {
    Ticks ticks;
    ticks.move(50);
    ASSERT_TRUE(ticks.leads());
    ticks.give_at(0.3, static_cast<std::uint32_t>(fault));
    EXPECT_FALSE(ticks.leads());
    for (int k = 0; k < 12; ++k) {  // 3 ms.
      ticks.move(1);
      EXPECT_FALSE(ticks.leads()) << k;
    }
    ticks.move(8);
    EXPECT_TRUE(ticks.leads());
  }
}

TEST(TargetLead, DoesNotLeadAtTheBegin) {
  Ticks ticks;
  for (int k = 0; k < 12; ++k) {
    EXPECT_FALSE(ticks.leads());
    ticks.move(1);
  }
}

TEST(TargetLead, NeedsSamples) {
  Ticks paused;
  paused.move(50);
  for (int k = 0; k < 10; ++k) {  // The same sample for 2.5 ms.
    paused.give(paused.tick.target, 0, false);
  }
  EXPECT_FALSE(paused.leads());
  paused.move(1);  // The gap is in the window now.
  EXPECT_FALSE(paused.leads());

  Ticks mouse;
  for (int k = 0; k < 1000; ++k) {  // 63 Hz.
    mouse.give({{0.2 * mouse.time(), 0.0, 0.0}, Eigen::Quaterniond::Identity()}, 0, k % 64 == 0);
    ASSERT_FALSE(mouse.leads()) << k;
  }
}

TEST(TargetLead, DoesNotLeadDevicesThatSetRates) {
  DeviceMapping mapping;
  mapping.kind = DeviceKind::rate;
  Ticks ticks(mapping);
  ticks.move(100);
  EXPECT_FALSE(ticks.leads());
}

TEST(TargetLead, LeadsByFourMillisecondsAtMost) {
  Ticks ticks;
  ticks.move(100);
  const Pose led = ticks.lead.target_in(0.5);
  EXPECT_NEAR(led.position.x() - ticks.tick.target.position.x(), 4e-3 * 0.2, 1e-12);
}

}  // namespace
}  // namespace firstcontact::detail
