/// @file
/// A recording as a device.

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/recording.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

struct RecordedDeviceOptions {
  /// [ns]  Time of `read` at which the first sample is due. By default the first call of `read`.
  std::optional<std::int64_t> start_ns = {};
  std::int64_t hold_last_ns = 100'000'000;  ///< [ns]  How long the last sample is held; >= 0.
};

/// Plays a recording back.
///
/// Between two stamps the last sample is held: nothing is interpolated, as no device knows the
/// future. Several samples between two ticks give the newest; `sequence` shows the jump. Before the
/// first sample the status is `waiting`, after the last it is `ended`. Commands are ignored.
/// For real loops and for loops in virtual time.
class FIRSTCONTACT_API RecordedDevice : public Device {
 public:
  /// @throws std::invalid_argument  if the recording has no samples, or they are out of order
  explicit RecordedDevice(Recording recording, const RecordedDeviceOptions& options = {});

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override;
  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;
  [[nodiscard]] std::string problem() const override;

  /// [ns]  From the first sample to the last.
  [[nodiscard]] std::int64_t duration_ns() const noexcept;

 private:
  DeviceCapabilities capabilities_;
  std::vector<DeviceState> samples_;  // In D; their times count from the first one.
  std::int64_t hold_last_ns_;
  std::optional<std::int64_t> start_ns_;
  std::size_t next_ = 0;                   // The first sample that is not due yet.
  std::atomic<std::uint64_t> played_{0};   // Samples that were due, without repeats.
  std::atomic<std::uint64_t> missing_{0};  // Numbers that the recording leaves out.
};

}  // namespace firstcontact
