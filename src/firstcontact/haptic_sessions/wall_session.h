/// @file
/// A haptic session on the wall clock: two threads, one for each loop.

#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptic_sessions/timing_histogram.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// The options of a session on the wall clock.
struct WallSessionOptions {
  double duration = 10.0;  ///< [s]  > 0
  /// Whether to request SCHED_FIFO, a processor for each loop and locked memory. The session goes
  /// on without a request that is refused.
  bool real_time = true;
  /// [s]  Time for which a loop that does nothing runs first, at most the duration; >= 0. It has
  /// the period, the priority and the processor of the force loop.
  double empty_duration = 0.2;
  /// [ns]  Delay added to each cycle of the contact loop, to study its effect; >= 0.
  std::int64_t contact_delay_ns = 0;
};

/// The requests that the system granted.
struct RealTimeGrant {
  bool force_fifo = false;
  bool contact_fifo = false;
  bool force_processor = false;
  bool contact_processor = false;
  bool locked_memory = false;
};

/// Ticks are counted by the binary digits of their number of contacts: 0, 1, 2 to 3, 4 to 7, ...
inline constexpr std::size_t kContactClasses = std::bit_width(kMostHapticContacts) + 1;

/// The least number of contacts of a class.
[[nodiscard]] constexpr std::size_t least_contacts(std::size_t contact_class) noexcept {
  return contact_class == 0 ? 0 : std::size_t{1} << (contact_class - 1);
}

/// The account of a session on the wall, with every tick counted.
struct WallSessionReport {
  RealTimeGrant granted = {};
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;     ///< Ticks that began more than a period after their time.
  std::uint64_t skipped_ticks = 0;  ///< Ticks whose time passed before the tick before them ended.
  std::uint64_t cycles = 0;
  /// [ns]  Time by which courses are behind the wall clock at the end. They move on by a period of
  /// the contact loop in each cycle. After a longer cycle the next one begins later.
  std::int64_t behind_ns = 0;
  std::uint64_t unread_ticks = 0;  ///< Ticks that the caller was too slow to take.
  TimingHistogram tick_cpu = {};   ///< Thread CPU time of the force loop's body.
  /// The same for each class of contacts.
  std::array<TimingHistogram, kContactClasses> tick_cpu_by_contacts = {};
  TimingHistogram tick_wall = {};   ///< Wall time of the same.
  TimingHistogram tick_delay = {};  ///< From the time of a tick to its begin.
  TimingHistogram cycle_wall = {};  ///< Wall time of a cycle of the contact loop.
  /// Thread CPU time of a cycle.
  TimingHistogram cycle_cpu = {};
  /// As tick_delay, measured before the session for a loop that does nothing.
  TimingHistogram empty_delay = {};
};

/// Runs a session on the wall clock.
///
/// Ticks and cycles are handed to the calling thread, which may write them down. It delays neither
/// loop. A slow contact loop makes no tick late: the force loop goes on with the newest contacts
/// there are, within HapticLimits. Targets of devices with regular samples are extrapolated by
/// their velocity, for one period of the contact loop.
///
/// @param options   as HapticSession, but without the latency: it is that of the machine
/// @param devices   one for each tool
/// @param on_tick   called with each tick, in order
/// @param on_cycle  called with each cycle, in order, and the time [ns] of its targets
/// @throws std::invalid_argument as HapticSession; a number of `wall` is out of its range
[[nodiscard]] FIRSTCONTACT_API WallSessionReport run_wall_session(
    HapticScene scene, const HapticSessionOptions& options, std::span<Device* const> devices,
    const WallSessionOptions& wall, const std::function<void(const ForceTick&)>& on_tick = {},
    const std::function<void(const HapticCycle&, std::int64_t)>& on_cycle = {},
    const std::stop_token& stop = {});

}  // namespace firstcontact
