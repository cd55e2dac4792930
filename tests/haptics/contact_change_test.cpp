// Forces and torques are continuous where contacts come and go.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptic_sessions/haptic_session.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Makes a box of three different sides above a floor whose top is at z = 0.
HapticScene box_on_floor() {
  HapticScene scene;
  scene.tools.push_back(tool_at("box", make_box({0.04, 0.05, 0.03}), {0.0, 0.0, 0.03}));
  scene.bodies.push_back(body_at("floor", make_box({1.0, 1.0, 0.1}), {0.0, 0.0, -0.05}));
  return scene;
}

/// The sample of a hand that presses the box 5 mm down and rocks it about y, and slightly about x.
DeviceState rocking(std::int64_t now_ns, std::uint64_t number) {
  const double time = 1e-9 * static_cast<double>(now_ns);
  const Vector3d turn(0.01, 0.3 * std::sin(time / 0.3), 0.0);
  DeviceState device;
  device.status = DeviceStatus::live;
  device.time_ns = now_ns;
  device.sequence = number;
  device.X_DH.position = Vector3d(0.0, 0.0, -0.02 * std::min(1.0, time / 0.2));
  device.X_DH.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return device;
}

TEST(ContactChange, LeavesTheForceOfARockingBoxContinuous) {
  HapticSessionOptions options;
  options.forces.limits.torque = 10.0;
  options.forces.limits.force_slew = 1e9;
  options.forces.limits.torque_slew = 1e9;
  options.forces.limits.ramp_ns = 0;
  HapticSession session(box_on_floor(), options);
  ToolTick last;
  double most_force = 0.0;
  double most_torque = 0.0;
  for (std::uint64_t k = 0; k < 4800; ++k) {
    const std::int64_t now_ns = session.time_ns();
    const ToolTick tick = session.step(std::array{rocking(now_ns, k + 1)}).tools[0];
    if (now_ns > 210'000'000 && last.faults == 0 && tick.faults == 0) {
      most_force = std::max(most_force, (tick.force_W - last.force_W).norm());
      most_torque = std::max(most_torque, (tick.torque_W - last.torque_W).norm());
    }
    last = tick;
  }
  EXPECT_GT(last.force_W.z(), 1.0);
  // The hand turns by 0.25 mrad in a tick, at a lever of 3 cm: that is less than 0.01 N and 0.3 mN
  // m.
  EXPECT_LT(most_force, 0.1);
  EXPECT_LT(most_torque, 3e-3);
}

}  // namespace
}  // namespace firstcontact
