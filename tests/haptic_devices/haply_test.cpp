#include <firstcontact/haptic_devices/haply.h>

#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "haptic_devices/fake_haply_service.h"

namespace firstcontact {
namespace {

using test::eventually;
using test::FakeHaplyService;
using test::haply_state;

HaplyOptions haply_options(const FakeHaplyService& service) {
  HaplyOptions options;
  options.host = "127.0.0.1";
  options.port = service.port();
  options.retry_ns = 2'000'000;
  options.connect_ns = 20'000'000'000;
  options.silent_after_ns = 10'000'000'000;  // Machines of tests stall.
  options.lost_after_ns = 10'000'000'000;
  return options;
}

DeviceState state_of(Haply& device) { return device.read(steady_now_ns()); }

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// What the service says of a device that is where the service before 3.5 is tested.
constexpr const char* kOlder = "04BA";
constexpr const char* kNewer = "049D";

TEST(Haply, ReadsStatesAndSendsForcesSince35) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.05));
  Haply device(haply_options(service));
  EXPECT_EQ(device.capabilities().id, kNewer);
  EXPECT_EQ(device.capabilities().name, "inverse3");
  EXPECT_EQ(device.capabilities().sensed, DegreesOfFreedom::all());
  EXPECT_EQ(device.capabilities().driven, DegreesOfFreedom::translation());
  ASSERT_TRUE(eventually([&] { return state_of(device).X_DH.position.x() == 0.05; }));
  const DeviceState state = state_of(device);
  EXPECT_EQ(state.status, DeviceStatus::live);
  EXPECT_NEAR(state.X_DH.position.norm(), 0.05, 1e-12);  // About the centre of the workspace.
  EXPECT_EQ(state.X_DH.rotation.x(), 1.0);               // As the grip had it last.
  ASSERT_TRUE(eventually([&] {
    device.command({{1.0, 0.0, -0.5}, {9.0, 9.0, 9.0}}, steady_now_ns());
    return has(service.last_message(), R"("set_cursor_force":{"vector":{"x":1,"y":0,"z":-0.5}})");
  })) << service.last_message();
  EXPECT_TRUE(has(service.messages().front(), "firstcontact:haptics"));
  EXPECT_FALSE(has(service.last_message(), "session"));
}

TEST(Haply, ReadsStatesAndSendsForcesBefore35) {
  FakeHaplyService service(test::kInventoryBefore35);
  service.set_answer(haply_state(kOlder, 0.02));
  Haply device(haply_options(service));
  ASSERT_TRUE(eventually([&] { return state_of(device).X_DH.position.x() == 0.02; }));
  ASSERT_TRUE(eventually([&] {
    device.command({{0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns());
    return has(service.last_message(), R"("values":{"x":0,"y":1,"z":0})");
  })) << service.last_message();
  EXPECT_FALSE(has(service.messages().front(), "session"));
}

TEST(Haply, SendsNoForceBeyondItsLimits) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.0));
  Haply device(haply_options(service));
  // Before the first command there is none.
  ASSERT_TRUE(eventually([&] { return service.messages().size() > 3; }));
  EXPECT_TRUE(has(service.last_message(), R"({"x":0,"y":0,"z":0})"));
  ASSERT_TRUE(eventually([&] {
    device.command({{0.0, 0.0, 100.0}, {0.0, 0.0, 0.0}}, steady_now_ns());
    return has(service.last_message(), R"("z":2})");
  }));
  device.command({{std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}, {0.0, 0.0, 0.0}},
                 steady_now_ns());
  ASSERT_TRUE(eventually([&] { return has(service.last_message(), R"({"x":0,"y":0,"z":0})"); }));
}

// The watchdog: a loop that stalls leaves no force.
TEST(Haply, SendsZeroWhereTheLastCommandIsOld) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.0));
  Haply device(haply_options(service));
  device.command({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns() - kCommandLifetimeNs - 1);
  ASSERT_TRUE(eventually([&] { return service.messages().size() > 10; }));
  for (const std::string& message : service.messages()) {
    EXPECT_TRUE(has(message, R"({"x":0,"y":0,"z":0})")) << message;
  }
}

TEST(Haply, GoesOnWhereAnswersAreLateOrLost) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.01));
  service.drop_every = 3;
  service.delay_us = 300;
  service.split = true;
  service.ping = true;
  Haply device(haply_options(service));
  ASSERT_TRUE(eventually([&] { return device.counts().samples > 20; }));
  EXPECT_EQ(state_of(device).status, DeviceStatus::live);
  ASSERT_TRUE(eventually([&] { return device.counts().missed > 0; }));
  ASSERT_TRUE(eventually([&] { return service.pongs == 1; }));
  EXPECT_EQ(service.connections, 1);
}

TEST(Haply, DropsWhatMakesNoSense) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e9,"y":0,"z":0}}}]})");
  Haply device(haply_options(service));
  ASSERT_TRUE(eventually([&] { return device.counts().malformed > 3; }));
  EXPECT_TRUE(has(device.problem(), "cursor_position.x")) << device.problem();
  EXPECT_LT(state_of(device).X_DH.position.norm(), 0.1);  // That of the inventory.
  service.set_answer("{not json");
  const std::uint64_t before = device.counts().malformed;
  ASSERT_TRUE(eventually([&] { return device.counts().malformed > before + 3; }));
  service.set_answer(haply_state(kNewer, 0.03));
  ASSERT_TRUE(eventually([&] { return state_of(device).X_DH.position.x() == 0.03; }));
}

TEST(Haply, IsLostWithItsDeviceAndKeepsTheConnection) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(R"({"session_id":7,"inverse3":[]})");
  Haply device(haply_options(service));
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::lost; }));
  EXPECT_TRUE(has(device.problem(), "no longer lists the device 049D")) << device.problem();
  ASSERT_TRUE(eventually([&] { return service.last_message() == "{}"; }));
  service.set_answer(haply_state(kNewer, 0.0, false));
  ASSERT_TRUE(eventually([&] { return has(device.problem(), "not ready"); }));
  service.set_answer(haply_state(kNewer, 0.04));
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::live; }));
  EXPECT_EQ(service.connections, 1);
  EXPECT_EQ(device.problem(), "");
}

TEST(Haply, ConnectsAgainWithoutTheOldForce) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.0));
  Haply device(haply_options(service));
  ASSERT_TRUE(eventually([&] {
    device.command({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns());
    return has(service.last_message(), R"("x":1,)");
  }));
  service.hang_up = true;
  ASSERT_TRUE(eventually([&] { return service.connections == 2; }));
  ASSERT_TRUE(eventually([&] { return device.counts().connections == 2; }));
  // The command was given before the connection; the next one counts again.
  ASSERT_TRUE(eventually([&] { return has(service.last_message(), R"({"x":0,"y":0,"z":0})"); }));
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::live; }));
  ASSERT_TRUE(eventually([&] {
    device.command({{0.5, 0.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns());
    return has(service.last_message(), R"("x":0.5,)");
  }));
}

TEST(Haply, IsSilentThenLostWhereNoAnswerComes) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.0));
  HaplyOptions options = haply_options(service);
  options.silent_after_ns = 20'000'000;
  options.lost_after_ns = 60'000'000;
  service.mute = true;
  Haply device(options);
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::silent; }));
  EXPECT_EQ(state_of(device).buttons, 0U);
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::lost; }));
  service.mute = false;
  ASSERT_TRUE(eventually([&] { return service.connections >= 2; }));
  ASSERT_TRUE(eventually([&] { return state_of(device).status == DeviceStatus::live; }));
}

TEST(Haply, LeavesTheDeviceWithoutForce) {
  FakeHaplyService service(test::kInventorySince35);
  service.set_answer(haply_state(kNewer, 0.0));
  {
    Haply device(haply_options(service));
    ASSERT_TRUE(eventually([&] {
      device.command({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, steady_now_ns());
      return has(service.last_message(), R"("x":1,)");
    }));
  }
  EXPECT_TRUE(eventually([&] { return has(service.last_message(), R"({"x":0,"y":0,"z":0})"); }));
}

TEST(Haply, SaysWhatToDoWhereNothingAnswers) {
  const auto message_of = [](const HaplyOptions& options) -> std::string {
    try {
      const Haply device(options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  {
    const auto [listener, port] = test::listen_tcp();
    HaplyOptions options;
    options.host = "127.0.0.1";
    options.port = port;
    options.connect_ns = 100'000'000;  // On a busy machine a host is not even looked up in 5 ms.
    EXPECT_TRUE(has(message_of(options), "no answer in time; start Haply Hub"))
        << message_of(options);
  }
  FakeHaplyService service(R"({"session_id":1,"inverse3":[]})");
  service.set_answer(R"({"inverse3":[]})");
  HaplyOptions options = haply_options(service);
  for (const char* id : {"", "0123"}) {
    options.device_id = id;
    const std::string wanted =
        options.device_id.empty() ? "lists no Inverse3; plug it in" : "lists no device 0123";
    // A machine that stalls may need a longer limit for the service's answer.
    std::string message;
    for (options.connect_ns = 20'000'000; options.connect_ns < 20'000'000'000;
         options.connect_ns *= 4) {
      message = message_of(options);
      if (has(message, wanted)) {
        break;
      }
    }
    EXPECT_TRUE(has(message, wanted)) << message;
  }
}

TEST(Haply, RefusesOptionsOutsideTheirRange) {
  HaplyOptions options;
  options.max_force = -1.0;
  EXPECT_THROW(Haply{options}, std::invalid_argument);
  options = {};
  options.rate = 0.0;
  EXPECT_THROW(Haply{options}, std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
