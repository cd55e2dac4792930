#include <firstcontact/haptic_devices/detail/space_mouse_rates.h>

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "haptic_devices/spacenav_records.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using test::button;
using test::device_event;
using test::motion;
using test::record;

std::vector<SpacenavEvent> events_of(SpacenavDecoder& decoder) {
  std::vector<SpacenavEvent> events;
  while (const auto event = decoder.next()) {
    events.push_back(*event);
  }
  return events;
}

TEST(SpacenavDecoder, ReadsRecords) {
  SpacenavDecoder decoder;
  decoder.add(motion({1, -2, 3, -4, 5, -6}) + button(3, true) + button(3, false) +
              device_event(true) + device_event(false) + record({4, 1}));
  const auto events = events_of(decoder);
  ASSERT_EQ(events.size(), 6U);
  EXPECT_EQ(events[0].type, SpacenavEventType::motion);
  EXPECT_EQ(events[0].axes, (std::array<std::int32_t, 6>{1, -2, 3, -4, 5, -6}));
  EXPECT_EQ(events[1].type, SpacenavEventType::press);
  EXPECT_EQ(events[1].value, 3);
  EXPECT_EQ(events[2].type, SpacenavEventType::release);
  EXPECT_EQ(events[3].type, SpacenavEventType::device_removed);
  EXPECT_EQ(events[4].type, SpacenavEventType::device_added);
  EXPECT_EQ(events[5].type, SpacenavEventType::other);
  EXPECT_EQ(decoder.malformed(), 0U);
  EXPECT_FALSE(decoder.inside_record());
}

// The answer has 4 bytes and may come behind an event.
TEST(SpacenavDecoder, FindsTheAnswerAmongEvents) {
  SpacenavDecoder decoder;
  decoder.add(motion({1, 0, 0, 0, 0, 0}) + test::agreed_protocol() + motion({2, 0, 0, 0, 0, 0}));
  const auto events = events_of(decoder);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[1].type, SpacenavEventType::protocol);
  EXPECT_EQ(events[1].value, 1);
  EXPECT_EQ(events[2].axes[0], 2);
}

TEST(SpacenavDecoder, DoesNotCareHowBytesArrive) {
  const std::string bytes = test::agreed_protocol() + motion({1, 2, 3, 4, 5, 6}) + button(0, true) +
                            motion({6, 5, 4, 3, 2, 1});
  SpacenavDecoder decoder;
  std::vector<SpacenavEvent> events;
  for (const char byte : bytes) {
    decoder.add({&byte, 1});
    for (const SpacenavEvent& event : events_of(decoder)) {
      events.push_back(event);
    }
  }
  ASSERT_EQ(events.size(), 4U);
  EXPECT_EQ(events[3].axes[5], 1);
}

TEST(SpacenavDecoder, LeavesOutWhatMakesNoSense) {
  SpacenavDecoder decoder;
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  decoder.add(record({99}) + motion({most, 0, 0, 0, 0, 0}) + button(-1, true) + record({3, 9}) +
              record({-1}) + motion({7, 0, 0, 0, 0, 0}) + "short");
  const auto events = events_of(decoder);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].axes[0], 7);
  EXPECT_EQ(decoder.malformed(), 5U);
  EXPECT_TRUE(decoder.inside_record());
}

SpacenavEvent moved(const std::array<std::int32_t, 6>& axes) {
  return {SpacenavEventType::motion, axes, 0};
}

/// The state right behind one deflection.
DeviceState state_behind(const std::array<std::int32_t, 6>& axes) {
  SpaceMouseRates rates{SpaceMouseOptions{}};
  rates.take(moved(axes), 5);
  return state_at(rates.sample(), 5, SpaceMouseOptions{});
}

TEST(SpaceMouseRates, TurnIntoTheAxesOfTheDevice) {
  // Right, up, away; then about these.
  EXPECT_EQ(state_behind({350, 0, 0, 0, 0, 0}).linear_rate, Vector3d(0.2, 0.0, 0.0));
  EXPECT_EQ(state_behind({0, 350, 0, 0, 0, 0}).linear_rate, Vector3d(0.0, 0.0, 0.2));
  EXPECT_EQ(state_behind({0, 0, 350, 0, 0, 0}).linear_rate, Vector3d(0.0, 0.2, 0.0));
  EXPECT_EQ(state_behind({0, 0, 0, -350, 0, 0}).angular_rate, Vector3d(-1.5, 0.0, 0.0));
  EXPECT_EQ(state_behind({0, 0, 0, 0, 350, 0}).angular_rate, Vector3d(0.0, 0.0, 1.5));
  EXPECT_EQ(state_behind({0, 0, 0, 0, 0, 350}).angular_rate, Vector3d(0.0, 1.5, 0.0));
  EXPECT_EQ(state_behind({350, 0, 0, 0, 0, 0}).status, DeviceStatus::live);
}

TEST(SpaceMouseRates, GrowFromTheDeadZoneToFullScale) {
  EXPECT_EQ(state_behind({15, -15, 3, 0, 0, 0}).linear_rate, Vector3d::Zero());
  EXPECT_NEAR(state_behind({16, 0, 0, 0, 0, 0}).linear_rate.x(), 0.2 / 335.0, 1e-15);
  EXPECT_NEAR(state_behind({-182, 0, 0, 0, 0, 0}).linear_rate.x(), -0.2 * 167.0 / 335.0, 1e-15);
  EXPECT_EQ(state_behind({5000, 0, 0, 0, 0, 0}).linear_rate.x(), 0.2);
}

TEST(SpaceMouseRates, EndWhereNoEventComes) {
  const SpaceMouseOptions options;
  SpaceMouseRates rates(options);
  rates.take({SpacenavEventType::press, {}, 2}, 0);
  rates.take(moved({200, 0, 0, 0, 0, 0}), 0);
  EXPECT_GT(state_at(rates.sample(), options.hold_ns, options).linear_rate.x(), 0.0);
  const DeviceState silent = state_at(rates.sample(), options.hold_ns + 1, options);
  EXPECT_EQ(silent.status, DeviceStatus::silent);
  EXPECT_EQ(silent.linear_rate, Vector3d::Zero());
  EXPECT_EQ(silent.buttons, 0U);
  // Silence at rest is what a cap does that nobody touches; the button is still held.
  rates.take(moved({0, 0, 0, 0, 0, 0}), 0);
  const DeviceState rest = state_at(rates.sample(), 100 * options.hold_ns, options);
  EXPECT_EQ(rest.status, DeviceStatus::live);
  EXPECT_EQ(rest.buttons, 4U);
}

// A daemon that repeats the last deflection behind the release of the cap.
TEST(SpaceMouseRates, TakeASmallConstantDeflectionForDrift) {
  const SpaceMouseOptions options;
  for (const std::int32_t counts : {40, 300}) {
    SpaceMouseRates rates(options);
    std::int64_t now_ns = 0;
    for (; now_ns <= options.drift_after_ns; now_ns += 100'000'000) {
      rates.take(moved({counts, 0, 0, 0, 0, 0}), now_ns);
      EXPECT_GT(state_at(rates.sample(), now_ns, options).linear_rate.x(), 0.0);
    }
    rates.take(moved({counts, 0, 0, 0, 0, 0}), now_ns);
    const DeviceState state = state_at(rates.sample(), now_ns, options);
    EXPECT_EQ(state.linear_rate.x() == 0.0, counts == 40) << counts;
    EXPECT_EQ(state.status, DeviceStatus::live);
    rates.take(moved({counts + 1, 0, 0, 0, 0, 0}), now_ns);
    EXPECT_GT(state_at(rates.sample(), now_ns, options).linear_rate.x(), 0.0);
  }
}

TEST(SpaceMouseRates, KeepButtonsApart) {
  SpaceMouseRates rates{SpaceMouseOptions{}};
  rates.take({SpacenavEventType::press, {}, 0}, 1);
  rates.take({SpacenavEventType::press, {}, 31}, 2);
  rates.take({SpacenavEventType::release, {}, 0}, 3);
  EXPECT_FALSE(rates.take({SpacenavEventType::press, {}, 32}, 4));
  EXPECT_EQ(rates.sample().state.buttons, 0x80000000U);
  EXPECT_EQ(rates.sample().state.sequence, 3U);
}

TEST(SpaceMouseRates, AreZeroWhenTheDeviceIsTakenAway) {
  SpaceMouseRates rates{SpaceMouseOptions{}};
  rates.take(moved({200, 0, 0, 0, 0, 0}), 1);
  rates.take({SpacenavEventType::device_removed, {}, 0}, 2);
  const DeviceState lost = state_at(rates.sample(), 2, SpaceMouseOptions{});
  EXPECT_EQ(lost.status, DeviceStatus::lost);
  EXPECT_EQ(lost.linear_rate, Vector3d::Zero());
  rates.take(moved({200, 0, 0, 0, 0, 0}), 3);
  EXPECT_EQ(state_at(rates.sample(), 3, SpaceMouseOptions{}).status, DeviceStatus::live);
}

}  // namespace
}  // namespace firstcontact::detail
