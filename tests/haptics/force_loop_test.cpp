// Forces of the force loop: their sizes, ramps and limits.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kTick = 250'000;  // [ns]

DeviceState handle_at(const Vector3d& position) {
  DeviceState device;
  device.X_DH.position = position;
  device.status = DeviceStatus::live;
  return device;
}

bool has(const ToolTick& tick, ForceFault fault) {
  return (tick.faults & static_cast<std::uint32_t>(fault)) != 0;
}

/// A cube that rests on the floor, and its set; the handle's zero is 1 cm above.
struct OnTheFloor {
  explicit OnTheFloor(const DeviceMapping& mapping = {}, const ForceLoopOptions& options = {},
                      double friction = 0.0)
      : contacts(cube_on_floor(friction)), forces(contacts.scene(), {mapping}, options) {
    Pose below = contacts.pose(0);
    below.position.z() = 0.0;
    for (int k = 0; k < 5; ++k) {
      (void)contacts.advance(std::array{below}, 1e-3, 0);
    }
  }

  const ToolTick& tick(const DeviceState& device) {
    now += kTick;
    set = contacts.contact_set();
    set.stamp_ns = now;
    return forces.tick(now, set, std::array{device}).tools[0];
  }

  ToolTick ticks(const DeviceState& device, int count) {
    ToolTick last;
    for (int k = 0; k < count; ++k) {
      last = tick(device);
    }
    return last;
  }

  ContactLoop contacts;
  ForceLoop forces;
  HapticContactSet set;
  std::int64_t now = 0;
};

constexpr int kRamp = 900;  // Ticks, longer than the ramp.

TEST(ForceLoop, PushesOutByTheStiffness) {
  OnTheFloor felt;
  const ToolTick tick = felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp);
  // The target is at 0.018, the cube at about 0.02: 2 mm at 1000 N/m.
  EXPECT_NEAR(tick.command.force_D.z(), 2.0, 0.03);
  EXPECT_NEAR(tick.command.force_D.head<2>().norm(), 0.0, 1e-6);
  EXPECT_NEAR(tick.command.torque_D.norm(), 0.0, 1e-6);
  EXPECT_EQ(tick.faults, 0U);
}

TEST(ForceLoop, IsExactlyZeroWithoutContactHoweverFarTheGodObjectLags) {
  ContactLoop contacts(cube_on_floor());
  ForceLoop forces(contacts.scene(), {{}});
  std::int64_t now = 0;
  for (int k = 0; k < 2000; ++k) {
    now += kTick;
    const double x = 0.3 * std::sin(0.01 * k);
    const ForceTick& tick =
        forces.tick(now, contacts.contact_set(), std::array{handle_at({x, 0.2, 0.5 + x})});
    ASSERT_EQ(tick.tools[0].command.force_D, Vector3d::Zero());
    ASSERT_EQ(tick.tools[0].command.torque_D, Vector3d::Zero());
  }
}

TEST(ForceLoop, GrowsOverTheRampAndNeverFasterThanTheSlew) {
  ForceLoopOptions options;
  options.limits.force_slew = 100.0;
  OnTheFloor felt({}, options);
  Vector3d last = Vector3d::Zero();
  for (int k = 0; k < 2 * kRamp; ++k) {
    const ToolTick& tick = felt.tick(handle_at({0.0, 0.0, k % 100 < 50 ? -0.02 : 0.02}));
    ASSERT_LE((tick.command.force_D - last).norm(), 100.0 * 1e-9 * kTick * (1.0 + 1e-9));
    last = tick.command.force_D;
  }
  EXPECT_TRUE(felt.tick(handle_at({0.0, 0.0, -0.02})).faults != 0);
}

TEST(ForceLoop, KeepsItsLimits) {
  OnTheFloor felt;
  const ToolTick tick = felt.ticks(handle_at({0.0, 0.0, -1.0}), kRamp);
  EXPECT_NEAR(tick.command.force_D.norm(), 10.0, 1e-9);
  EXPECT_TRUE(has(tick, ForceFault::limited));
}

/// A cube that turns about a point beside its middle, pressed on the floor by an edge.
ToolTick pressed_by_an_edge(const HapticLimits& limits) {
  HapticScene scene = cube_on_floor();
  scene.tools[0].p_BC = {0.02, 0.0, 0.0};
  ForceLoopOptions options;
  options.limits = limits;
  HapticSession session(scene, {.forces = options});
  DeviceState device = handle_at({0.0, 0.0, -0.02});
  device.X_DH.rotation = Eigen::AngleAxisd(0.1, Vector3d::UnitY());
  ToolTick last;
  for (int k = 0; k < 2 * kRamp; ++k) {
    last = session.step(std::array{device}).tools[0];
  }
  return last;
}

// A force that is cut has less torque, or it is not one of the contacts.
DeviceMapping driving(const DegreesOfFreedom& driven, double max_force) {
  DeviceMapping mapping;
  mapping.device.emplace();
  mapping.device->driven = driven;
  mapping.device->max_force = max_force;
  return mapping;
}

TEST(ForceLoop, CommandsWhatTheDeviceDrives) {
  const DeviceState below = handle_at({0.0, 0.0, -0.016});
  const ToolTick free = OnTheFloor(DeviceMapping{}).ticks(below, 2000);
  EXPECT_GT(free.asked.force_D.z(), 5.0);
  EXPECT_EQ(free.command.force_D, free.asked.force_D);
  EXPECT_FALSE(has(free, ForceFault::limited));
  const ToolTick none = OnTheFloor(driving(DegreesOfFreedom::none(), 0.0)).ticks(below, 2000);
  EXPECT_EQ(none.asked.force_D, free.asked.force_D);
  EXPECT_EQ(none.command.force_D, Vector3d::Zero());
  EXPECT_FALSE(has(none, ForceFault::limited));  // Axes that are not driven are no limit.
  const ToolTick weak =
      OnTheFloor(driving(DegreesOfFreedom::translation(), 2.0)).ticks(below, 2000);
  EXPECT_NEAR(weak.command.force_D.norm(), 2.0, 1e-12);
  EXPECT_TRUE(has(weak, ForceFault::limited));
}

TEST(ForceLoop, TellsThatNothingCouldBeProven) {
  OnTheFloor scene;
  HapticContactSet set = scene.contacts.contact_set();
  const std::array devices{handle_at({0.0, 0.0, 0.1})};
  EXPECT_FALSE(has(scene.forces.tick(kTick, set, devices).tools[0], ForceFault::unproven));
  set.is_unproven = true;
  EXPECT_TRUE(has(scene.forces.tick(2 * kTick, set, devices).tools[0], ForceFault::unproven));
  EXPECT_STREQ(kForceFaultWords.back(), "unproven");
}

TEST(ForceLoop, LimitsKeepTheWrenchOneOfContacts) {
  const ToolTick whole = pressed_by_an_edge({.force = 1e3, .torque = 1e3});
  const double force = whole.force_W.norm();
  const double torque = whole.torque_W.norm();
  ASSERT_GT(torque, 0.01);
  const auto require = [&](const HapticLimits& limits, double part) {
    const ToolTick cut = pressed_by_an_edge(limits);
    EXPECT_TRUE(has(cut, ForceFault::limited));
    EXPECT_LT((cut.force_W - part * whole.force_W).norm(), 1e-6 * force);
    EXPECT_LT((cut.torque_W - part * whole.torque_W).norm(), 1e-6 * torque);
  };
  require({.force = 0.3 * force, .torque = torque}, 0.3);
  require({.force = force, .torque = 0.2 * torque}, 0.2);
  // A device without torque has its force nevertheless.
  const ToolTick cut = pressed_by_an_edge({.force = 0.3 * force, .torque = 0.0});
  EXPECT_LT((cut.force_W - 0.3 * whole.force_W).norm(), 1e-6 * force);
  EXPECT_EQ(cut.torque_W, Vector3d::Zero());
}

TEST(ForceLoop, IsZeroAtOnceForNaNAndForALostDevice) {
  OnTheFloor felt;
  EXPECT_GT(felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp).command.force_D.norm(), 1.0);
  DeviceState wrong = handle_at({0.0, std::numeric_limits<double>::quiet_NaN(), -0.012});
  ToolTick tick = felt.tick(wrong);
  EXPECT_EQ(tick.command.force_D, Vector3d::Zero());
  EXPECT_TRUE(has(tick, ForceFault::not_finite));
  // When it comes back the force grows from nothing.
  tick = felt.tick(handle_at({0.0, 0.0, -0.012}));
  EXPECT_LT(tick.command.force_D.norm(), 0.01);
  (void)felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp);
  DeviceState lost = handle_at({0.0, 0.0, -0.012});
  lost.status = DeviceStatus::lost;
  tick = felt.tick(lost);
  EXPECT_EQ(tick.command.force_D, Vector3d::Zero());
  EXPECT_TRUE(has(tick, ForceFault::device));
  EXPECT_TRUE(tick.target.position.allFinite());
}

TEST(ForceLoop, DecaysToZeroWithTheAgeOfTheSet) {
  OnTheFloor felt;
  (void)felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp);
  double last = 10.0;
  std::int64_t now = felt.now;
  for (std::int64_t age = 0; age <= 160'000'000; age += kTick) {
    now += kTick;
    const ForceTick& tick =
        felt.forces.tick(now, felt.set, std::array{handle_at({0.0, 0.0, -0.012})});
    const double force = tick.tools[0].command.force_D.norm();
    ASSERT_LE(force, last + 1e-12);
    last = force;
    if (age >= 150'000'000) {
      ASSERT_EQ(force, 0.0);
    }
  }
}

TEST(ForceLoop, GrowsToItsLimitOverTheRampHoweverDeepTheDeviceStarts) {
  for (const double depth : {0.02, 1.0}) {
    OnTheFloor felt;
    const DeviceState device = handle_at({0.0, 0.0, -0.01 - depth});
    EXPECT_NEAR(felt.ticks(device, 400).command.force_D.z(), 5.0, 0.05) << depth;
    EXPECT_NEAR(felt.ticks(device, 400).command.force_D.z(), 10.0, 0.05) << depth;
  }
}

// A set comes after the last one was stale: the force grows again from what it was then.
TEST(ForceLoop, DoesNotKickWhereSetsComeAgain) {
  for (const std::int64_t pause : {100'000'000, 300'000'000}) {
    OnTheFloor felt;
    const DeviceState device = handle_at({0.0, 0.0, -0.016});
    (void)felt.ticks(device, kRamp);
    double last = 0.0;
    for (const std::int64_t end = felt.now + pause; felt.now < end;) {
      felt.now += kTick;
      last = felt.forces.tick(felt.now, felt.set, std::array{device}).tools[0].force_W.z();
    }
    EXPECT_NEAR(last, pause < 200'000'000 ? 3.0 : 0.0, 0.05);
    for (int k = 0; k < kRamp; ++k) {
      const double force = felt.tick(device).force_W.z();
      ASSERT_LE(force, last + 0.01) << pause << ", " << k;
      last = force;
    }
    EXPECT_NEAR(last, 6.0, 0.03);
  }
}

TEST(ForceLoop, ClutchLetsGoAndTakesUpWhereTheGodObjectIs) {
  OnTheFloor felt({.clutch_button = 2});
  (void)felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp);
  DeviceState held = handle_at({0.0, 0.0, -0.012});
  held.buttons = 1U << 2;
  ToolTick tick = felt.ticks(held, 50);
  EXPECT_EQ(tick.command.force_D, Vector3d::Zero());
  EXPECT_TRUE(has(tick, ForceFault::disengaged));
  // Deep below the floor it is let go: there is the god-object now.
  tick = felt.ticks(handle_at({0.5, 0.0, -0.3}), kRamp);
  EXPECT_LT((tick.target.position - felt.contacts.pose(0).position).norm(), 1e-12);
  EXPECT_LT(tick.command.force_D.norm(), 1e-6);
  tick = felt.ticks(handle_at({0.5, 0.0, -0.302}), kRamp);
  EXPECT_NEAR(tick.command.force_D.z(), 2.0, 0.03);
}

TEST(ForceLoop, DeadManButtonIsNeededForAnyForce) {
  OnTheFloor felt({.dead_man_button = 0});
  EXPECT_EQ(felt.ticks(handle_at({0.0, 0.0, -0.012}), kRamp).command.force_D, Vector3d::Zero());
}

TEST(ForceLoop, ScalesSoThatWorkIsTheSame) {
  // The tool goes five times as far, turned by a quarter turn about z.
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
  OnTheFloor felt({.R_WD = quarter, .scale = 5.0});
  // D's z is the world's x, D's x is the world's -z.
  const ToolTick tick = felt.ticks(handle_at({0.0022, 0.0, 0.0}), kRamp);
  EXPECT_NEAR(tick.target.position.z(), 0.03 - 5.0 * 0.0022, 1e-12);
  EXPECT_NEAR(tick.command.force_D.x(), -5.0 * tick.force_W.z(), 1e-9);
  EXPECT_GT(tick.force_W.z(), 0.5);
  EXPECT_LT((tick.device_force_W() - quarter * tick.command.force_D).norm(), 1e-9);
}

TEST(ForceLoop, RefusesAStiffnessThatWouldFeelRoundedCoordinates) {
  HapticScene scene = cube_on_floor();
  scene.tools[0].coupling.stiffness = 1e20;
  EXPECT_THROW(HapticSession{scene}, std::invalid_argument);
  scene.tools[0].coupling = {.stiffness = 1000.0, .angular_stiffness = 1e18};
  EXPECT_THROW(HapticSession{scene}, std::invalid_argument);
}

// A cube of some nanometres, pressed by a tenth of its size: the hand feels 3 N at any size.
TEST(ForceLoop, FeelsAToolOfAnySize) {
  for (const double size : {0.03, 3e-6, 3e-7, 3e-8, 5e-9}) {
    HapticScene scene;
    scene.tools = {tool_at("cube", make_box({size, size, size}), {0.0, 0.0, size})};
    scene.bodies = {
        body_at("plate", make_box({20.0 * size, 20.0 * size, size}), {0.0, 0.0, -0.5 * size})};
    const double scale = size / 0.03;
    scene.tools[0].coupling = {.stiffness = 1000.0 / (scale * scale), .angular_stiffness = 1.0};
    HapticSession session(scene, {.mappings = {{.scale = scale}}});
    ToolTick tick;
    for (int k = 0; k < 4000; ++k) {
      DeviceState hand = handle_at({0.0, 0.0, -0.018 * std::min(1.0, k / 1000.0)});
      hand.time_ns = session.time_ns();
      hand.sequence = static_cast<std::uint64_t>(k + 1);
      tick = session.step(std::array{hand}).tools[0];
    }
    EXPECT_NEAR(tick.device_force_W().z(), 3.0, 0.02) << size;
    EXPECT_EQ(tick.faults, 0U) << size;
  }
}

TEST(ForceLoop, RateDevicesLeadByLittle) {
  OnTheFloor felt({.kind = DeviceKind::rate});
  DeviceState device;
  device.status = DeviceStatus::live;
  device.linear_rate = {0.0, 0.0, -0.1};
  const ToolTick tick = felt.ticks(device, 8000);
  EXPECT_LE((tick.target.position - felt.contacts.pose(0).position).norm(), 0.02 + 1e-12);
}

// Closed form: the spring, and damping times the hand's velocity, after pauses of any length too.
TEST(ForceLoop, DampsByTheTrueVelocityAfterAPause) {
  constexpr double kSpeed = 0.05;
  constexpr double kDamping = 20.0;
  HapticScene scene = cube_on_floor();
  scene.tools[0].coupling.damping = kDamping;
  ContactLoop contacts(scene);
  Pose below = contacts.pose(0);
  below.position.z() = 0.0;
  for (int k = 0; k < 5; ++k) {
    (void)contacts.advance(std::array{below}, 1e-3, 0);
  }
  ForceLoop forces(scene, {{}}, {.limits = {.force = 100.0, .force_slew = 1e9, .ramp_ns = 0}});
  HapticContactSet set = contacts.contact_set();
  const double floor = contacts.pose(0).position.z() - 0.03 - set.contacts[0].way;
  std::int64_t now = 0;
  for (int k = 0; k < 400; ++k) {
    now += k % 100 == 99 ? 100 * kTick : kTick;
    set.stamp_ns = now;
    const double z = -0.012 - kSpeed * 1e-9 * static_cast<double>(now);
    const ForceTick& tick = forces.tick(now, set, std::array{handle_at({0.0, 0.0, z})});
    if (k > 80) {
      ASSERT_NEAR(tick.tools[0].force_W.z(), 1000.0 * (floor - z) + kDamping * kSpeed, 0.01) << k;
    }
  }
}

TEST(ForceLoop, RefusesNumbersOutOfRange) {
  const HapticScene scene = cube_on_floor();
  EXPECT_THROW((ForceLoop{scene, {}}), std::invalid_argument);
  EXPECT_THROW((ForceLoop{scene, {{.scale = 0.0}}}), std::invalid_argument);
  ForceLoopOptions options;
  options.limits.stale_ns = 1;
  EXPECT_THROW((ForceLoop{scene, {{}}, options}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
