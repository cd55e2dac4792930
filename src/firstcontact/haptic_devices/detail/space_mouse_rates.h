/// @file
/// Converts events of spacenavd to rates of the device frame.

#pragma once

#include <array>
#include <cstdint>

#include <firstcontact/haptic_devices/detail/spacenav_protocol.h>
#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/space_mouse.h>

namespace firstcontact::detail {

/// The newest state, and when the deflection changed.
struct SpaceMouseSample {
  DeviceState state;
  std::int64_t changed_ns = 0;  ///< [ns]  Time since which the counts are the same.
  double deflection = 0.0;      ///< [-]   The greatest count over full scale; 0 in the dead zone.
};

/// Follows the events of a daemon.
class SpaceMouseRates {
 public:
  explicit SpaceMouseRates(const SpaceMouseOptions& options) : options_(options) {}

  /// Takes an event that arrived at `now_ns`. False where it changes nothing.
  bool take(const SpacenavEvent& event, std::int64_t now_ns);

  /// Begins a new connection: no sample yet.
  void connected();

  /// Notes that the daemon is gone.
  void lost();

  [[nodiscard]] const SpaceMouseSample& sample() const { return sample_; }

 private:
  void take_motion(const std::array<std::int32_t, 6>& axes, std::int64_t now_ns);

  SpaceMouseOptions options_;
  SpaceMouseSample sample_;
  std::array<std::int32_t, 6> axes_{};
};

/// Computes the state at the time of a tick: silence and drift give no rates.
[[nodiscard]] DeviceState state_at(const SpaceMouseSample& sample, std::int64_t now_ns,
                                   const SpaceMouseOptions& options) noexcept;

}  // namespace firstcontact::detail
