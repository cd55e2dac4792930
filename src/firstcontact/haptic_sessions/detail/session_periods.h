/// @file
/// The periods of a session's loops.

#pragma once

#include <cstdint>

#include <firstcontact/haptic_sessions/haptic_session.h>

namespace firstcontact::detail {

/// The periods of a session in nanoseconds.
struct SessionPeriods {
  std::int64_t force_ns = 0;    ///< [ns]
  std::int64_t cycle_ns = 0;    ///< [ns]  A whole number of ticks.
  std::int64_t latency_ns = 0;  ///< [ns]  A whole number of ticks.
};

/// Computes the periods of a session.
///
/// @throws std::invalid_argument if a rate or the latency is out of its range
[[nodiscard]] SessionPeriods session_periods(const HapticSessionOptions& options);

/// [s]  Computes the time by which the targets of a cycle are extrapolated: to the middle of the
/// ticks that feel its contacts.
[[nodiscard]] double lead_of(const SessionPeriods& periods);

}  // namespace firstcontact::detail
