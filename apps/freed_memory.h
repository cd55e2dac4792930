/// @file
/// Memory of the process: what is freed, and the stack.

#pragma once

namespace firstcontact::app {

/// Keeps what is freed for what is needed next: given back to the system, the tables of each step
/// of a simulation would be mapped in anew, page by page (a seventh of its time).
void keep_freed_memory();

/// Takes half a MiB of stack while there is some. The system adds to the stack of the first thread
/// page by page, and ends a process that has no address space left for the next one by a signal,
/// where it might as well report that memory ran out.
void take_stack();

}  // namespace firstcontact::app
