/// @file
/// Logs of a haptic session as CSV: ticks of the force loop, cycles of the contact loop, timing.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptic_sessions/wall_session.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Columns that only scenes with grips have.
struct GripColumns {
  std::size_t grips = 0;   ///< Number of grips of the tool that has most.
  std::size_t joints = 0;  ///< Number of joints of all tools.
};

/// The grip columns of a scene's logs.
[[nodiscard]] FIRSTCONTACT_API GripColumns grip_columns(const HapticScene& scene,
                                                        const HapticSessionOptions& options);

/// The first line of a log of ticks. Numbers read back to the same double.
[[nodiscard]] FIRSTCONTACT_API std::string haptic_tick_header(const GripColumns& columns = {});

/// Writes the lines of a tick, one for each tool.
[[nodiscard]] FIRSTCONTACT_API std::string haptic_tick_lines(const ForceTick& tick,
                                                             std::size_t tools,
                                                             const GripColumns& columns = {});

/// The first line of a log of cycles.
[[nodiscard]] FIRSTCONTACT_API std::string haptic_cycle_header(const GripColumns& columns = {});

/// Writes the line of a cycle.
///
/// @param time_ns  time of the targets that the cycle followed
[[nodiscard]] FIRSTCONTACT_API std::string haptic_cycle_line(const HapticCycle& cycle,
                                                             std::int64_t time_ns);

/// Writes the histograms of a session on the wall clock as CSV: what,from_ns,count for each bucket
/// with a count. `tick_cpu_contacts_8` has the ticks with 8 contacts or more, below 16.
[[nodiscard]] FIRSTCONTACT_API std::string haptic_timing_csv(const WallSessionReport& report);

/// The words of the faults of a tick, joined by a bar; empty without a fault.
[[nodiscard]] FIRSTCONTACT_API std::string fault_words(std::uint32_t faults);

}  // namespace firstcontact
