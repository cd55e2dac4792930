#include <firstcontact/haptic_devices/recorded_device.h>

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Samples at 0, 10, 10, 40 ns of places 1, 2, 3, 4 along x, with numbers 5, 6, 8, 8.
Recording short_recording() {
  Recording recording;
  const std::int64_t times[] = {1000, 1010, 1010, 1040};
  const std::uint64_t numbers[] = {5, 6, 8, 8};
  for (int i = 0; i < 4; ++i) {
    DeviceState sample;
    sample.X_DH.position.x() = i + 1;
    sample.time_ns = times[i];
    sample.sequence = numbers[i];
    sample.buttons = 1;
    sample.status = DeviceStatus::live;
    recording.samples.push_back(sample);
  }
  return recording;
}

TEST(RecordedDevice, HoldsTheLastSample) {
  RecordedDevice device(short_recording(), {.start_ns = 200, .hold_last_ns = 5});
  EXPECT_EQ(device.duration_ns(), 40);
  EXPECT_EQ(device.read(199).status, DeviceStatus::waiting);
  const double places[] = {1.0, 1.0, 3.0, 3.0, 4.0, 4.0};
  const std::int64_t times[] = {200, 209, 210, 239, 240, 245};
  for (int i = 0; i < 6; ++i) {
    const DeviceState state = device.read(times[i]);
    EXPECT_EQ(state.status, DeviceStatus::live) << i;
    EXPECT_EQ(state.X_DH.position.x(), places[i]) << i;
    EXPECT_EQ(state.buttons, 1U);
    EXPECT_LE(state.time_ns, times[i]);
  }
  const DeviceState end = device.read(246);
  EXPECT_EQ(end.status, DeviceStatus::ended);
  EXPECT_EQ(end.X_DH.position.x(), 4.0);
  EXPECT_EQ(end.buttons, 0U);
}

TEST(RecordedDevice, CountsRepeatsAndGaps) {
  RecordedDevice device(short_recording());
  (void)device.read(7);
  EXPECT_EQ(device.counts().samples, 1U);
  const DeviceState state = device.read(1'000'000);
  EXPECT_EQ(state.sequence, 8U);
  EXPECT_EQ(device.counts().samples, 3U);  // 8 stands twice.
  EXPECT_EQ(device.counts().missed, 1U);   // 7
}

TEST(RecordedDevice, StartsAtTheFirstReadByDefault) {
  RecordedDevice device(short_recording());
  EXPECT_EQ(device.read(5'000'000).X_DH.position.x(), 1.0);
  EXPECT_EQ(device.read(5'000'010).time_ns, 5'000'010);
}

TEST(RecordedDevice, PassesOnThatTheDeviceWasLost) {
  Recording recording = short_recording();
  recording.samples[1].status = DeviceStatus::lost;
  recording.samples[2].status = DeviceStatus::lost;
  RecordedDevice device(std::move(recording), {.start_ns = 0});
  EXPECT_EQ(device.read(0).status, DeviceStatus::live);
  const DeviceState lost = device.read(20);
  EXPECT_EQ(lost.status, DeviceStatus::lost);
  EXPECT_EQ(lost.buttons, 0U);
  EXPECT_EQ(device.read(40).status, DeviceStatus::live);
}

TEST(RecordedDevice, IsSilentInGapsThatAreTooLong) {
  Recording recording = short_recording();
  recording.capabilities.silent_after_ns = 20;
  RecordedDevice device(std::move(recording), {.start_ns = 0});
  EXPECT_EQ(device.read(30).status, DeviceStatus::live);
  EXPECT_EQ(device.read(31).status, DeviceStatus::silent);
  EXPECT_EQ(device.read(40).status, DeviceStatus::live);
}

TEST(RecordedDevice, TakesTheWholeRangeOfTimes) {
  Recording recording = short_recording();
  recording.samples.front().time_ns = std::numeric_limits<std::int64_t>::min();
  recording.samples.back().time_ns = std::numeric_limits<std::int64_t>::max();
  RecordedDevice device(std::move(recording), {.start_ns = 0});
  EXPECT_EQ(device.read(0).X_DH.position.x(), 1.0);
  EXPECT_EQ(device.read(std::numeric_limits<std::int64_t>::max()).X_DH.position.x(), 4.0);
}

TEST(RecordedDevice, RefusesRecordingsOutOfOrder) {
  EXPECT_THROW(RecordedDevice(Recording{}), std::invalid_argument);
  Recording recording = short_recording();
  std::swap(recording.samples[0], recording.samples[3]);
  EXPECT_THROW(RecordedDevice{recording}, std::invalid_argument);
  EXPECT_THROW(RecordedDevice(short_recording(), {.hold_last_ns = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
