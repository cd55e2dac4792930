/// @file
/// Requests to the system for a thread that must not be late.

#pragma once

namespace firstcontact::detail {

/// Requests SCHED_FIFO with a priority for the calling thread.
///
/// @returns  whether it was granted
[[nodiscard]] bool take_real_time_priority(int priority) noexcept;

/// Binds the calling thread to a processor, by its number among those on which it may run.
[[nodiscard]] bool bind_to_processor(int number) noexcept;

/// Keeps all memory of the process from being paged out, from now on. Returns whether that was
/// granted.
[[nodiscard]] bool lock_memory() noexcept;
/// Ends lock_memory().
void unlock_memory() noexcept;

}  // namespace firstcontact::detail
