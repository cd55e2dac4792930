/// @file
/// A SpaceMouse, or another device that spacenavd serves.

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// The options of a SpaceMouse.
struct SpaceMouseOptions {
  /// The socket of the daemon. Empty: $SPNAV_SOCKET, or else /var/run/spnav.sock.
  std::string socket;
  double full_scale = 350.0;  ///< [counts]  Deflection that sets the greatest rate; > 0.
  double dead_zone = 15.0;  ///< [counts]  A smaller deflection counts as rest; in [0, full_scale).
  double max_linear_rate = 0.2;   ///< [m/s]     Greatest rate along each axis; > 0.
  double max_angular_rate = 1.5;  ///< [rad/s]   Greatest rate about each axis; > 0.
  /// [ns]  Time for which a deflection without a further event is held; then the device is
  /// `silent`.
  std::int64_t hold_ns = 500'000'000;
  /// [ns]  Time after which an unchanging deflection below `drift_below` is taken for drift. Its
  /// rates are 0 until it changes.
  std::int64_t drift_after_ns = 2'000'000'000;
  double drift_below = 0.25;            ///< [-]   Share of full scale, in [0, 1].
  std::int64_t retry_ns = 250'000'000;  ///< [ns]  Pause between two tries to connect again; > 0.
};

/// A SpaceMouse through the socket of spacenavd. A rate device without force.
///
/// A thread of its own reads the socket. If the daemon ends, or reports that the device was taken
/// away, the status is `lost`; the thread goes on trying to connect. While the cap is at rest no
/// events come, and the status stays `live`.
///
/// The rates grow linearly from 0 at the edge of the dead zone to the greatest rate at full scale.
/// No library of the daemon is needed. Not tried on hardware.
class FIRSTCONTACT_API SpaceMouse : public Device {
 public:
  /// Connects to the daemon.
  ///
  /// @throws std::invalid_argument  if an option is outside its range
  /// @throws std::runtime_error     if no daemon answers, with the mend
  explicit SpaceMouse(const SpaceMouseOptions& options = {});
  ~SpaceMouse() override;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override;
  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override;
  [[nodiscard]] std::string problem() const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
