#include <firstcontact/haptic_devices/recorded_device.h>

#include <limits>
#include <stdexcept>
#include <utility>

#include <firstcontact/haptic_devices/detail/quiet_state.h>

namespace firstcontact {
namespace {

/// Computes a - b, or the nearest integer that can be represented.
std::int64_t saturated_difference(std::int64_t a, std::int64_t b) noexcept {
  std::int64_t result = 0;
  if (__builtin_sub_overflow(a, b, &result)) {
    return a < b ? std::numeric_limits<std::int64_t>::min()
                 : std::numeric_limits<std::int64_t>::max();
  }
  return result;
}

}  // namespace

RecordedDevice::RecordedDevice(Recording recording, const RecordedDeviceOptions& options)
    : capabilities_(std::move(recording.capabilities)),
      samples_(std::move(recording.samples)),
      hold_last_ns_(options.hold_last_ns),
      start_ns_(options.start_ns) {
  if (samples_.empty()) {
    throw std::invalid_argument("RecordedDevice: the recording has no samples");
  }
  if (hold_last_ns_ < 0) {
    throw std::invalid_argument("RecordedDeviceOptions::hold_last_ns must be >= 0, got " +
                                std::to_string(hold_last_ns_));
  }
  const std::int64_t first = samples_.front().time_ns;
  std::int64_t last = first;
  std::uint64_t sequence = samples_.front().sequence;
  for (DeviceState& sample : samples_) {
    if (sample.time_ns < last || sample.sequence < sequence) {
      throw std::invalid_argument("RecordedDevice: times or sequence numbers decrease");
    }
    last = sample.time_ns;
    sequence = sample.sequence;
    sample = calibrated(sample, recording.calibration);
    sample.time_ns = saturated_difference(sample.time_ns, first);
  }
}

const DeviceCapabilities& RecordedDevice::capabilities() const noexcept { return capabilities_; }

std::int64_t RecordedDevice::duration_ns() const noexcept { return samples_.back().time_ns; }

DeviceState RecordedDevice::read(std::int64_t now_ns) noexcept {
  if (!start_ns_) {
    start_ns_ = now_ns;
  }
  const std::int64_t played = saturated_difference(now_ns, *start_ns_);
  while (next_ < samples_.size() && samples_[next_].time_ns <= played) {
    const std::uint64_t step =
        next_ == 0 ? 1 : samples_[next_].sequence - samples_[next_ - 1].sequence;
    played_.fetch_add(step > 0 ? 1 : 0, std::memory_order_relaxed);
    missing_.fetch_add(step > 0 ? step - 1 : 0, std::memory_order_relaxed);
    ++next_;
  }
  if (next_ == 0) {
    return {};
  }
  DeviceState state = samples_[next_ - 1];
  const std::int64_t age = saturated_difference(played, state.time_ns);
  state.time_ns = saturated_difference(now_ns, age);
  if (state.status != DeviceStatus::live) {
    return detail::quiet(state, state.status);
  }
  if (next_ == samples_.size() && age > hold_last_ns_) {
    return detail::quiet(state, DeviceStatus::ended);
  }
  return age > capabilities_.silent_after_ns ? detail::quiet(state, DeviceStatus::silent) : state;
}

void RecordedDevice::command(const ForceCommand& /*command*/, std::int64_t /*now_ns*/) noexcept {}

DeviceCounts RecordedDevice::counts() const {
  return {played_.load(std::memory_order_relaxed), missing_.load(std::memory_order_relaxed), 0, 1};
}

std::string RecordedDevice::problem() const { return {}; }

}  // namespace firstcontact
