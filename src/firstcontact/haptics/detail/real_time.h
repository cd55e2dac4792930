/// @file
/// What the system grants a thread that must not be late.

#pragma once

namespace firstcontact::detail {

/// Asks for SCHED_FIFO with a priority for the calling thread.
///
/// @returns  whether it was granted
[[nodiscard]] bool take_real_time_priority(int priority) noexcept;

/// Binds the calling thread to a processor that it may run on, by its number among these.
[[nodiscard]] bool bind_to_processor(int number) noexcept;

/// Keeps all memory of the process from being paged out, from now on.
[[nodiscard]] bool lock_memory() noexcept;
void unlock_memory() noexcept;

}  // namespace firstcontact::detail
