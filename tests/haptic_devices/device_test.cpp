#include <firstcontact/haptic_devices/device.h>

#include <limits>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

DeviceCapabilities driven_device() {
  DeviceCapabilities capabilities;
  capabilities.driven = DegreesOfFreedom::all();
  capabilities.max_force = 4.0;
  capabilities.max_torque = 0.5;
  return capabilities;
}

TEST(LimitedCommand, KeepsWhatTheDeviceCanDo) {
  const ForceCommand command{{1.0, -2.0, 3.0}, {0.1, 0.2, -0.3}};
  const ForceCommand result = limited(command, driven_device());
  EXPECT_EQ(result.force_D, command.force_D);
  EXPECT_EQ(result.torque_D, command.torque_D);
}

TEST(LimitedCommand, ShortensLongVectorsWithoutTurningThem) {
  const ForceCommand result = limited({{30.0, 0.0, 40.0}, {0.0, -7.0, 0.0}}, driven_device());
  EXPECT_TRUE(result.force_D.isApprox(Vector3d(2.4, 0.0, 3.2), 1e-15)) << result.force_D;
  EXPECT_TRUE(result.torque_D.isApprox(Vector3d(0.0, -0.5, 0.0), 1e-15)) << result.torque_D;
  const double huge = std::numeric_limits<double>::max();
  EXPECT_NEAR(limited({{huge, huge, -huge}, Vector3d::Zero()}, driven_device()).force_D.norm(), 4.0,
              1e-14);
}

TEST(LimitedCommand, IsZeroWhereANumberIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_EQ(limited({{bad, 1.0, 1.0}, {0.1, 0.0, 0.0}}, driven_device()).torque_D,
              Vector3d::Zero());
    EXPECT_EQ(limited({{1.0, 1.0, 1.0}, {0.1, bad, 0.0}}, driven_device()).force_D,
              Vector3d::Zero());
  }
}

TEST(LimitedCommand, DropsWhatIsNotDriven) {
  DeviceCapabilities capabilities = driven_device();
  capabilities.driven = DegreesOfFreedom::translation();
  capabilities.max_torque = 0.0;
  capabilities.driven.linear[1] = false;
  const ForceCommand result = limited({{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}}, capabilities);
  EXPECT_EQ(result.force_D, Vector3d(1.0, 0.0, 1.0));
  EXPECT_EQ(result.torque_D, Vector3d::Zero());
}

TEST(LimitedCommand, HasNoLimitWhereTheMakerStatesNone) {
  DeviceCapabilities capabilities = driven_device();
  capabilities.max_force = std::numeric_limits<double>::infinity();
  EXPECT_EQ(limited({{1e30, 0.0, 0.0}, Vector3d::Zero()}, capabilities).force_D,
            Vector3d(1e30, 0.0, 0.0));
}

TEST(SteadyClock, DoesNotGoBack) {
  std::int64_t last = steady_now_ns();
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t now = steady_now_ns();
    ASSERT_GE(now, last);
    last = now;
  }
}

}  // namespace
}  // namespace firstcontact
