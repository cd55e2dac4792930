// Each tool feels its own contacts, and nothing of those that do not press on it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/force_loop.h>

#include "haptics/grip_scenes.h"
#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kStep = 250'000;  // [ns]

DeviceState device_held_at(const Vector3d& position) {
  DeviceState device;
  device.X_DH.position = position;
  device.status = DeviceStatus::live;
  return device;
}

bool ends_unsolved(const ToolTick& tick) {
  return (tick.faults & static_cast<std::uint32_t>(ForceFault::unsolved)) != 0;
}

ForceLoopOptions without_limits() {
  return {.limits = {.force = 1e6,
                     .torque = 1e6,
                     .force_slew = 1e12,
                     .torque_slew = 1e12,
                     .grip_effort = 1e6,
                     .ramp_ns = 0}};
}

/// A contact of the environment with a tool or one of its links.
HapticContact contact_of(std::int32_t tool, std::int32_t link, const Vector3d& point,
                         const Vector3d& normal) {
  HapticContact contact;
  contact.tool = tool;
  contact.link = link;
  contact.body = 0;
  contact.point = point;
  contact.normal = normal.normalized();
  contact.gap = 1e-6;
  return contact;
}

/// Adds two surfaces that close on a tool from nearly opposite sides.
void add_squeeze(std::int32_t tool, std::int32_t link, const Vector3d& point,
                 HapticContactSet& set) {
  for (const double side : {1.0, -1.0}) {
    HapticContact& contact = set.contacts[set.count++];
    contact = contact_of(tool, link, point, {side, 1e-12, 7e-13 * side});
    contact.friction = 0.5;
    contact.surface_velocity = {side, 0.0, 0.0};
  }
}

HapticScene two_cubes() {
  HapticScene scene;
  scene.tools.push_back(tool_at("first", make_box({0.02, 0.02, 0.02}), {0.0, 0.0, 0.0}));
  scene.tools.push_back(tool_at("second", make_box({0.02, 0.02, 0.02}), {1.0, 0.0, 0.0}));
  return scene;
}

/// A set with the tools where they start, and without contacts.
HapticContactSet empty_set(const HapticScene& scene) {
  HapticContactSet set;
  set.tools = static_cast<std::uint32_t>(scene.tools.size());
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    set.X_WB[k] = scene.tools[k].X_WB;
    set.p_WC[k] = scene.tools[k].X_WB.position;
  }
  return set;
}

/// Ticks with contacts that stay or change: a new set each tick.
struct Ticking {
  Ticking(const HapticScene& scene, const std::vector<DeviceMapping>& mappings)
      : forces(scene, mappings, without_limits()) {
    // No time has passed in the first tick, so that the slew permits no force.
    const std::vector<DeviceState> devices(mappings.size(), device_held_at(Vector3d::Zero()));
    (void)tick(empty_set(scene), devices);
  }

  const ForceTick& tick(HapticContactSet set, std::span<const DeviceState> devices) {
    set.sequence = ++sequence;
    set.stamp_ns = now;
    now += kStep;
    return forces.tick(now, set, devices);
  }

  ForceLoop forces;
  std::uint64_t sequence = 0;
  std::int64_t now = 0;
};

TEST(ContactForces, AToolThatLeavesItsContactFeelsNothingWhileTheOtherIsUnsolved) {
  const HapticScene scene = two_cubes();
  Ticking felt(scene, {{}, {}});
  const std::array devices{device_held_at({0.0, 0.0, -0.002}), device_held_at({0.001, 0.0, 0.0})};
  HapticContactSet pressed = empty_set(scene);
  pressed.contacts[pressed.count++] = contact_of(0, -1, {0.0, 0.0, -0.01}, Vector3d::UnitZ());
  EXPECT_NEAR(felt.tick(pressed, devices).tools[0].force_W.z(), 2.0, 1e-6);
  HapticContactSet squeezed = empty_set(scene);
  add_squeeze(1, -1, {1.0, 0.0, 0.0}, squeezed);
  const ForceTick& tick = felt.tick(squeezed, devices);
  EXPECT_TRUE(ends_unsolved(tick.tools[1]));
  EXPECT_FALSE(ends_unsolved(tick.tools[0]));
  EXPECT_EQ(tick.tools[0].force_W, Vector3d::Zero());
  EXPECT_EQ(tick.tools[0].torque_W, Vector3d::Zero());
}

// The law of a tool alone, to the last bit.
TEST(ContactForces, AToolFeelsTheSameWhateverTheOtherOneTouches) {
  const HapticScene scene = two_cubes();
  const std::array devices{device_held_at({0.0003, 0.0, -0.002}),
                           device_held_at({0.001, 0.0, 0.0})};
  const auto force_beside = [&](bool is_squeezed) {
    Ticking felt(scene, {{}, {}});
    HapticContactSet set = empty_set(scene);
    set.contacts[set.count++] = contact_of(0, -1, {0.004, 0.0, -0.01}, Vector3d::UnitZ());
    set.contacts[0].friction = 0.3;
    if (is_squeezed) {
      add_squeeze(1, -1, {1.0, 0.0, 0.0}, set);
    }
    return felt.tick(set, devices).tools[0].force_W;
  };
  EXPECT_EQ(force_beside(true), force_beside(false));
  EXPECT_GT(force_beside(true).z(), 1.0);
}

// Tools that touch each other are one problem: the one that is pressed on no more feels nothing.
TEST(ContactForces, AToolThatOnlyTouchesAnUnsolvedOneFeelsNothing) {
  const HapticScene scene = two_cubes();
  Ticking felt(scene, {{}, {}});
  const std::array devices{device_held_at({0.0, 0.0, -0.002}), device_held_at({0.001, 0.0, 0.0})};
  HapticContactSet pressed = empty_set(scene);
  pressed.contacts[pressed.count++] = contact_of(0, -1, {0.0, 0.0, -0.01}, Vector3d::UnitZ());
  (void)felt.tick(pressed, devices);
  HapticContactSet squeezed = empty_set(scene);
  HapticContact& between = squeezed.contacts[squeezed.count++];
  between = contact_of(0, -1, {0.0, 0.0, 0.01}, -Vector3d::UnitZ());
  between.body = -1;
  between.other = 1;
  between.way = 0.1;
  add_squeeze(1, -1, {1.0, 0.0, 0.0}, squeezed);
  const ForceTick& tick = felt.tick(squeezed, devices);
  EXPECT_TRUE(ends_unsolved(tick.tools[1]));
  EXPECT_EQ(tick.tools[0].force_W, Vector3d::Zero());
}

// Closed form: two springs in series, though the hand of the second tool feels nothing.
TEST(ContactForces, AToolFeelsTheSpringOfAnotherThatIsNotEngaged) {
  for (const double stiffness : {1000.0, 4000.0}) {
    HapticScene scene = two_cubes();
    scene.tools[0].X_WB.position.x() = -0.03;
    scene.tools[1].X_WB.position.x() = 0.0;
    scene.tools[1].coupling.stiffness = stiffness;
    HapticSession session(scene,
                          {.forces = without_limits(), .mappings = {{}, {.clutch_button = 0}}});
    ForceTick last;
    for (int k = 0; k < 1600; ++k) {
      DeviceState second = device_held_at(Vector3d::Zero());
      second.buttons = k > 20 ? 1U : 0U;
      const double way = std::min(0.016, 2e-5 * k);
      last = session.step(std::array{device_held_at({way, 0.0, 0.0}), second});
    }
    const double overlap = 0.006 + 1.375 * session.contacts().contact_distance();
    EXPECT_NEAR(last.tools[0].force_W.x(), -overlap / (1e-3 + 1.0 / stiffness), 1e-3) << stiffness;
    EXPECT_EQ(last.tools[1].force_W, Vector3d::Zero());
  }
}

TEST(ContactForces, AFingerWithoutContactFeelsNothingWhileAnotherIsUnsolved) {
  HapticScene scene;
  scene.tools.push_back(jaws());
  Ticking felt(scene, {one_grip(kJawWay)});
  DeviceState device = device_held_at(Vector3d::Zero());
  device.grips[0] = 0.5;
  HapticContactSet first = empty_set(scene);
  first.joint_count = 2;
  first.link_count = 2;
  for (std::size_t link = 0; link < 2; ++link) {
    first.axes[link].direction = (link == 0 ? -1.0 : 1.0) * Vector3d::UnitX();
  }
  HapticContactSet second = first;
  first.contacts[first.count++] = contact_of(0, 0, {0.03, 0.0, -0.03}, Vector3d::UnitX());
  const double effort = felt.tick(first, std::array{device}).joint_efforts[0];
  EXPECT_LT(effort, -1.0);
  add_squeeze(0, 1, {-0.03, 0.0, -0.03}, second);
  const ForceTick& tick = felt.tick(second, std::array{device});
  EXPECT_TRUE(ends_unsolved(tick.tools[0]));
  EXPECT_EQ(tick.joint_efforts[0], 0.0);
}

}  // namespace
}  // namespace firstcontact
