/// @file
/// A haptic session in virtual time: both loops in one thread, the same on every run.

#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// [Hz]  The lowest rate of a force loop: no hand feels steps of 10 ms as a surface.
inline constexpr double kLeastForceRate = 100.0;

/// The options of a haptic session.
struct HapticSessionOptions {
  double force_rate = 4000.0;    ///< [Hz]  In [kLeastForceRate, 1e6].
  double contact_rate = 1000.0;  ///< [Hz]  In (0, force_rate].
  /// [ns]  Virtual time that a cycle of the contact loop takes, at least a tick; >= 0.
  std::int64_t contact_latency_ns = 0;
  ContactLoopOptions contacts = {};
  ForceLoopOptions forces = {};
  std::vector<DeviceMapping> mappings = {};  ///< One for each tool; the default for those missing.
};

/// Steps a force loop and a contact loop in virtual time.
///
/// The contact loop begins a cycle with the targets of a tick. Its contacts act from the tick on at
/// which its latency is over. Targets of devices with regular samples are extrapolated by their
/// velocity, to the middle of the ticks that feel the contacts.
class FIRSTCONTACT_API HapticSession {
 public:
  /// Makes a session at time 0.
  ///
  /// @throws std::invalid_argument as ContactLoop and ForceLoop; or a rate or the latency is out of
  /// its range
  explicit HapticSession(HapticScene scene, const HapticSessionOptions& options = {});
  ~HapticSession();
  HapticSession(HapticSession&&) noexcept;
  HapticSession& operator=(HapticSession&&) noexcept;

  /// Makes the next tick of the force loop, and the cycle of the contact loop that begins with it.
  ///
  /// @param devices  one for each tool
  /// @throws std::invalid_argument if they are not as many as the tools
  const ForceTick& step(std::span<const DeviceState> devices);

  /// The cycle that the last step has run; null where it ran none.
  [[nodiscard]] const HapticCycle* cycle() const;

  /// Delays the contacts of the cycle that runs, or of the next one, and all cycles after it: the
  /// contact loop stalls, once.
  ///
  /// @param stall_ns  [ns]  >= 0 and at most 10 s
  /// @throws std::invalid_argument if it is not
  void stall_contacts(std::int64_t stall_ns);

  [[nodiscard]] std::int64_t time_ns() const;          ///< [ns]  Time of the next tick.
  [[nodiscard]] std::int64_t force_period_ns() const;  ///< [ns]  Period of the force loop.
  /// [ns]  Period of the contact loop, latency included.
  [[nodiscard]] std::int64_t cycle_period_ns() const;
  [[nodiscard]] const ContactLoop& contacts() const;
  /// The contacts that the next tick will act on, if no cycle ends before.
  [[nodiscard]] const HapticContactSet& contact_set() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Completes the mappings of a session's options to one for each tool.
[[nodiscard]] FIRSTCONTACT_API std::vector<DeviceMapping> complete_mappings(
    const HapticScene& scene, const std::vector<DeviceMapping>& mappings);

}  // namespace firstcontact
