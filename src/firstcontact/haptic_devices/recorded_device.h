/// @file
/// A haptic device that plays a recording back.

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

/// The options of a recorded device.
struct RecordedDeviceOptions {
  /// [ns]  Time of `read` at which the first sample is due; the first call of `read` by default.
  std::optional<std::int64_t> start_ns = {};
  std::int64_t hold_last_ns = 100'000'000;  ///< [ns]  How long the last sample is held; >= 0.
};

/// Plays a recording back. For real loops and for loops in virtual time.
///
/// Between two stamps the last sample is held. Nothing is interpolated, as no device knows the
/// future. Where several samples lie between two ticks, `read` gives the newest; `sequence` shows
/// the jump. Before the first sample the status is `waiting`, after the last it is `ended`.
/// Commands are ignored.
class FIRSTCONTACT_API RecordedDevice : public Device {
 public:
  /// Plays `recording`.
  ///
  /// @throws std::invalid_argument  if the recording has no samples, or they are out of order
  explicit RecordedDevice(Recording recording, const RecordedDeviceOptions& options = {});

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override;
  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;
  [[nodiscard]] std::string problem() const override;

  /// [ns]  Time from the first sample to the last.
  [[nodiscard]] std::int64_t duration_ns() const noexcept;

 private:
  DeviceCapabilities capabilities_;
  std::vector<DeviceState> samples_;  // Poses and rates in D; times count from the first sample.
  std::int64_t hold_last_ns_;
  std::optional<std::int64_t> start_ns_;
  std::size_t next_ = 0;                   // Index of the first sample that is not due yet.
  std::atomic<std::uint64_t> played_{0};   // Samples that were due, without repeats.
  std::atomic<std::uint64_t> missing_{0};  // Sequence numbers that the recording leaves out.
};

}  // namespace firstcontact
