#include <firstcontact/haptic_devices/load_device_plugin.h>

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

/// The message of the error that a library gives, without its path.
std::string plugin_refusal(const std::string& path, const std::string& settings = {}) {
  try {
    (void)load_device_plugin(path, settings);
  } catch (const ParseError& error) {
    EXPECT_EQ(error.path(), path);
    return error.message();
  }
  return "no error";
}

TEST(DevicePlugin, IsADeviceLikeAnyOther) {
  const auto device = load_device_plugin(PLUGIN_NONE);
  const DeviceCapabilities& capabilities = device->capabilities();
  EXPECT_EQ(capabilities.name, "faulty");
  EXPECT_EQ(capabilities.driven, DegreesOfFreedom::translation());
  EXPECT_TRUE(std::isinf(capabilities.workspace_radius));
  device->command({{100.0, 0.0, 0.0}, {7.0, 0.0, 0.0}}, 5);
  const DeviceState state = device->read(7);
  EXPECT_EQ(state.status, DeviceStatus::live);
  EXPECT_EQ(state.X_DH.position, Eigen::Vector3d(3.0, 0.25, 0.0));  // The force it got.
  EXPECT_EQ(state.time_ns, 7);
  device->command({{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, {0.0, 0.0, 0.0}}, 8);
  EXPECT_EQ(device->read(9).X_DH.position.x(), 0.0);
  EXPECT_EQ(device->counts().samples, 2U);
  EXPECT_EQ(device->problem(), "");
}

TEST(DevicePlugin, DropsSamplesThatMakeNoSense) {
  const auto device = load_device_plugin(PLUGIN_BAD_SAMPLES);
  for (int round = 0; round < 10; ++round) {
    EXPECT_EQ(device->read(round).status, DeviceStatus::live);
    EXPECT_EQ(device->problem(), "");  // It makes sense again.
    for (int bad = 0; bad < 2; ++bad) {
      const DeviceState state = device->read(round);
      EXPECT_EQ(state.status, DeviceStatus::lost);
      EXPECT_EQ(state.X_DH.position.y(), 0.25);
      EXPECT_EQ(state.buttons, 0U);
    }
  }
  EXPECT_EQ(device->counts().malformed, 20U);
  EXPECT_EQ(device->problem(), "the plug-in gives samples that make no sense");
}

TEST(DevicePlugin, IsRefusedForAReason) {
  EXPECT_EQ(plugin_refusal("/no/such/plugin.so"),
            "expected a plug-in for a haptic device, found no file");
  EXPECT_NE(plugin_refusal(std::string(FIRSTCONTACT_SOURCE_DIR) + "/README.md")
                .find("expected a shared library: "),
            std::string::npos);
  EXPECT_EQ(plugin_refusal(PLUGIN_NO_ENTRY),
            "is no plug-in for a haptic device: it exports no firstcontact_device_plugin(); see "
            "docs/haptic_devices.md");
  EXPECT_EQ(plugin_refusal(PLUGIN_OTHER_VERSION),
            "was made for version 999 of the plug-in interface, this is version 1; compile it with "
            "the device_plugin.h of this version");
  EXPECT_NE(plugin_refusal(PLUGIN_OTHER_SIZE).find("other sizes"), std::string::npos);
  EXPECT_EQ(plugin_refusal(PLUGIN_NO_READ),
            "one of its functions open, describe, read, command, close is missing");
  EXPECT_EQ(plugin_refusal(PLUGIN_NO_OPEN), "cannot open its device: the arm is switched off");
  EXPECT_EQ(plugin_refusal(PLUGIN_BAD_ABILITIES),
            "its device has a max_torque that is negative or no number");
}

TEST(DevicePlugin, HasGrips) {
  const auto device = load_device_plugin(PLUGIN_GRIPS);
  EXPECT_EQ(device->capabilities().grips, 2);
  EXPECT_EQ(device->capabilities().max_grip_effort, 0.5);
  EXPECT_EQ(load_device_plugin(PLUGIN_NONE)->capabilities().grips, 0);
  ForceCommand command;
  command.grips = {-0.7, 0.0, 3.0};
  device->command(command, 5);
  DeviceState state = device->read(6);
  EXPECT_EQ(state.grips[0], 0.25);
  EXPECT_EQ(state.grips[1], -0.5);  // As it is limited; the third is not one of its grips.
  EXPECT_EQ(state.grips[2], 0.0);
  (void)device->read(7);
  state = device->read(8);  // A value that is no number.
  EXPECT_EQ(state.status, DeviceStatus::lost);
  EXPECT_EQ(state.grips[0], 0.25);
  EXPECT_EQ(plugin_refusal(PLUGIN_BAD_GRIPS), "its device has 17 grips; expected 0 to 16");
}

TEST(ExamplePlugin, MovesOnItsOrbit) {
  const auto device = load_device_plugin(PLUGIN_ORBIT, "radius=0.05");
  EXPECT_EQ(device->capabilities().name, "orbit");
  std::uint64_t last = 0;
  for (std::int64_t tick = 0; tick < 400; ++tick) {
    const DeviceState state = device->read(tick * 1'000'000);
    ASSERT_EQ(state.status, DeviceStatus::live);
    ASSERT_NEAR(state.X_DH.position.norm(), 0.05, 1e-12);
    ASSERT_GT(state.sequence, last);
    last = state.sequence;
  }
  // A force pushes the handle off by its length over the stiffness of the orbit.
  device->command({{0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}}, 400'000'000);
  EXPECT_NEAR(device->read(401'000'000).X_DH.position.z(), 1.0 / 500.0, 1e-12);
  // Behind 100 ms without a command there is no force.
  EXPECT_EQ(device->read(501'000'000).X_DH.position.z(), 0.0);
  EXPECT_EQ(plugin_refusal(PLUGIN_ORBIT, "radius=x"),
            "cannot open its device: settings: expected radius=NUMBER in metres");
}

}  // namespace
}  // namespace firstcontact
