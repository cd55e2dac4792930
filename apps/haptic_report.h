/// @file
/// A report in words on a haptic session.

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_sessions/wall_session.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::app {

/// Counts ticks and cycles, and keeps the greatest and least of their numbers.
class HapticReport {
 public:
  void add(const ForceTick& tick, std::size_t tools);
  void add(const HapticCycle& cycle);

  [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
  [[nodiscard]] double time_lost() const { return time_lost_; }  ///< [s]

  /// Returns the lines for the standard output.
  ///
  /// @param undriven  a note behind the forces, "the mouse drives none of it"; may be empty
  /// @param wall  none in virtual time
  [[nodiscard]] std::string text(const std::string& scene, bool is_stopped,
                                 const std::string& undriven,
                                 const std::optional<WallSessionReport>& wall) const;

 private:
  std::uint64_t ticks_ = 0;
  std::uint64_t cycles_ = 0;
  double force_ = 0.0;                                          // [N]
  double torque_ = 0.0;                                         // [N m]
  double clearance_ = std::numeric_limits<double>::infinity();  // [m]
  double time_lost_ = 0.0;                                      // [s]
  std::size_t contacts_ = 0;
  std::uint64_t touching_ = 0;    // Number of cycles that ended with contacts.
  std::uint64_t unfinished_ = 0;  // Number of cycles that could have gained more.
  std::uint32_t faults_ = 0;
  double effort_ = 0.0;  // [J]  Effort on a grip.
  bool has_joints_ = false;
};

/// The efforts that a device does not drive: "the mouse drives none of it", or "the inverse3 drives
/// no torque"; empty where it drives both.
[[nodiscard]] std::string undriven_text(const Device& device);

/// Describes a device that a hand moved: its name, its samples, and the reason of a loss.
[[nodiscard]] std::string device_text(const Device& device);

}  // namespace firstcontact::app
