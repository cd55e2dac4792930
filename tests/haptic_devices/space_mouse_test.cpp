#include <firstcontact/haptic_devices/space_mouse.h>

#include <optional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "haptic_devices/local_server.h"
#include "haptic_devices/spacenav_records.h"

namespace firstcontact {
namespace {

using test::button;
using test::eventually;
using test::motion;
using test::send_bytes;

/// A daemon of the test on a socket of its own.
class FakeDaemon {
 public:
  FakeDaemon() : path(folder_.file("spnav.sock")), listener_(test::listen_local(path)) {}

  /// Takes a connection, and the request for a protocol.
  void accept(bool answers = true) {
    client = test::accept_one(listener_);
    request = test::receive_bytes(client, 20'000);
    if (answers) {
      send_bytes(client, test::agreed_protocol());
    }
  }

  void stop() { listener_ = detail::FileDescriptor(); }
  void restart() { listener_ = test::listen_local(path); }
  void hang_up() { client = detail::FileDescriptor(); }

 private:
  test::TemporaryFolder folder_;

 public:
  const std::string path;
  detail::FileDescriptor client;
  std::string request;

 private:
  detail::FileDescriptor listener_;
};

SpaceMouseOptions mouse_options(const FakeDaemon& daemon) {
  SpaceMouseOptions options;
  options.socket = daemon.path;
  options.retry_ns = 2'000'000;
  options.hold_ns = 20'000'000'000;  // Machines of tests stall.
  options.drift_after_ns = 20'000'000'000;
  return options;
}

DeviceState state_of_mouse(SpaceMouse& mouse) { return mouse.read(steady_now_ns()); }

TEST(SpaceMouse, FollowsTheDaemon) {
  FakeDaemon daemon;
  SpaceMouse mouse(mouse_options(daemon));
  daemon.accept();
  EXPECT_EQ(daemon.request, std::string("\x01\x55\xaa\x7f", 4));
  EXPECT_EQ(mouse.capabilities().kind, DeviceKind::rate);
  EXPECT_EQ(mouse.capabilities().driven, DegreesOfFreedom::none());
  EXPECT_EQ(state_of_mouse(mouse).status, DeviceStatus::waiting);
  send_bytes(daemon.client, motion({350, 0, 0, 0, 0, 0}) + button(1, true));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).buttons == 2; }));
  EXPECT_EQ(state_of_mouse(mouse).linear_rate.x(), 0.2);
  EXPECT_EQ(state_of_mouse(mouse).sequence, 2U);
  EXPECT_TRUE(eventually([&] { return mouse.problem().empty(); })) << mouse.problem();
  mouse.command({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns());  // Nothing happens.
}

TEST(SpaceMouse, TakesBurstsAndBrokenRecords) {
  FakeDaemon daemon;
  SpaceMouse mouse(mouse_options(daemon));
  daemon.accept();
  std::string burst;
  for (std::int32_t i = 0; i < 20'000; ++i) {
    burst += motion({i % 300, 0, 0, 0, 0, 0});
  }
  burst += test::record({77}) + motion({0, -350, 0, 0, 0, 0}).substr(0, 31);
  send_bytes(daemon.client, burst);
  ASSERT_TRUE(eventually([&] { return mouse.counts().samples == 20'000; }));
  EXPECT_GT(state_of_mouse(mouse).linear_rate.x(), 0.0);
  // The rest of the record, later.
  send_bytes(daemon.client, motion({0, -350, 0, 0, 0, 0}).substr(31));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).linear_rate.z() == -0.2; }));
  EXPECT_EQ(mouse.counts().malformed, 1U);
  // A record that never ends.
  send_bytes(daemon.client, "half");
  daemon.hang_up();
  ASSERT_TRUE(eventually([&] { return mouse.counts().malformed == 2; }));
}

TEST(SpaceMouse, IsLostWithTheDaemonAndComesBack) {
  FakeDaemon daemon;
  SpaceMouse mouse(mouse_options(daemon));
  daemon.accept();
  send_bytes(daemon.client, motion({350, 0, 0, 0, 0, 0}) + button(0, true));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).buttons == 1; }));
  const std::uint64_t sequence = state_of_mouse(mouse).sequence;
  daemon.stop();
  daemon.hang_up();
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).status == DeviceStatus::lost; }));
  EXPECT_EQ(state_of_mouse(mouse).linear_rate, Eigen::Vector3d::Zero());
  EXPECT_EQ(state_of_mouse(mouse).buttons, 0U);
  ASSERT_TRUE(eventually([&] {
    return mouse.problem().find("no connection to spacenavd") != std::string::npos;
  })) << mouse.problem();
  daemon.restart();
  daemon.accept();
  ASSERT_TRUE(eventually([&] { return mouse.counts().connections == 2; }));
  send_bytes(daemon.client, motion({0, 0, 350, 0, 0, 0}));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).status == DeviceStatus::live; }));
  EXPECT_EQ(state_of_mouse(mouse).linear_rate, Eigen::Vector3d(0.0, 0.2, 0.0));
  EXPECT_GT(state_of_mouse(mouse).sequence, sequence);
}

TEST(SpaceMouse, IsLostWhenTheDeviceIsTakenAway) {
  FakeDaemon daemon;
  SpaceMouse mouse(mouse_options(daemon));
  daemon.accept();
  send_bytes(daemon.client, motion({350, 0, 0, 0, 0, 0}) + test::device_event(true));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).status == DeviceStatus::lost; }));
  EXPECT_EQ(mouse.problem(), "spacenavd reports that the device was taken away");
}

// A daemon of version 0 takes the request for a sensitivity that is no number.
TEST(SpaceMouse, GivesOldDaemonsTheirSensitivityBack) {
  FakeDaemon daemon;
  SpaceMouse mouse(mouse_options(daemon));
  daemon.accept(false);
  const std::string sensitivity = test::receive_bytes(daemon.client, 20'000);
  float value = 0.0F;
  ASSERT_EQ(sensitivity.size(), sizeof value);
  std::memcpy(&value, sensitivity.data(), sizeof value);
  EXPECT_EQ(value, 1.0F);
  send_bytes(daemon.client, motion({350, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(eventually([&] { return state_of_mouse(mouse).linear_rate.x() == 0.2; }));
}

TEST(SpaceMouse, SaysHowToStartTheDaemon) {
  const test::TemporaryFolder folder;
  SpaceMouseOptions options;
  options.socket = folder.file("none.sock");
  try {
    const SpaceMouse mouse(options);
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(options.socket + ": No such file"), std::string::npos) << message;
    EXPECT_NE(message.find("systemctl start spacenavd"), std::string::npos) << message;
  }
}

TEST(SpaceMouse, RefusesOptionsOutsideTheirRange) {
  SpaceMouseOptions options;
  options.dead_zone = 400.0;
  EXPECT_THROW(SpaceMouse{options}, std::invalid_argument);
  options = {};
  options.hold_ns = 0;
  EXPECT_THROW(SpaceMouse{options}, std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
