/// @file
/// Memory of the process: what is freed, and the stack.

#pragma once

namespace firstcontact::app {

/// Keeps freed memory for what is needed next.
///
/// Else the tables of each step of a simulation go back to the system, and are mapped in anew page
/// by page: a seventh of the time of a step.
void keep_freed_memory();

/// Takes half a MiB of stack while there is some.
///
/// The system adds to the stack of the first thread page by page. Where no address space is left
/// for the next page a signal ends the process, and no message reports that memory ran out.
void take_stack();

}  // namespace firstcontact::app
