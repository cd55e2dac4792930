/// @file
/// A haptic session on the wall clock: two threads, one for each loop.

#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptics/haptic_session.h>
#include <firstcontact/haptics/timing_histogram.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

struct WallSessionOptions {
  double duration = 10.0;  ///< [s]  > 0
  /// Requests SCHED_FIFO, a processor for each loop and locked memory; goes on without what is
  /// refused.
  bool real_time = true;
  /// [ns]  >= 0  Slows the contact loop down by so much each cycle, to see what that does.
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

/// The account of a session on the wall, with every tick counted.
struct WallSessionReport {
  RealTimeGrant granted = {};
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;     ///< That began more than a period after their time.
  std::uint64_t skipped_ticks = 0;  ///< Whose time had passed before the one before them ended.
  std::uint64_t cycles = 0;
  std::uint64_t unread_ticks = 0;   ///< That the caller was too slow to take; 0 if all were logged.
  TimingHistogram tick_cpu = {};    ///< Thread CPU time of the force loop's body.
  TimingHistogram tick_wall = {};   ///< Wall time of it.
  TimingHistogram tick_delay = {};  ///< From the time of a tick to its begin.
  TimingHistogram cycle_wall = {};  ///< Of the contact loop.
  TimingHistogram cycle_cpu = {};
  TimingHistogram empty_delay = {};  ///< As tick_delay, of a loop that does nothing, before.
};

/// Runs a session on the wall clock.
///
/// Ticks and cycles are handed to the calling thread, which may write them down: it keeps neither
/// loop from going on. A contact loop that is slow makes no tick late: the force loop goes on with
/// the newest contacts there are, as HapticLimits say. Cycles lead targets of devices with regular
/// samples by their velocity, for one period of the contact loop.
///
/// @param options   as HapticSession, but without the latency: it is that of the machine
/// @param devices   one for each tool
/// @param on_tick   called with each tick, in order
/// @param on_cycle  called with each cycle, in order, and the time [ns] of its targets
/// @throws std::invalid_argument as HapticSession; the duration is not > 0
[[nodiscard]] FIRSTCONTACT_API WallSessionReport run_wall_session(
    HapticScene scene, const HapticSessionOptions& options, std::span<Device* const> devices,
    const WallSessionOptions& wall, const std::function<void(const ForceTick&)>& on_tick = {},
    const std::function<void(const HapticCycle&, std::int64_t)>& on_cycle = {},
    const std::stop_token& stop = {});

}  // namespace firstcontact
