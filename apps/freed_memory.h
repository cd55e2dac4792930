/// @file
/// Memory of the process: freed memory, and the stack.

#pragma once

namespace firstcontact::app {

/// Keeps freed memory for later use.
///
/// Otherwise the tables of each step of a simulation go back to the system. They are mapped in
/// again page by page, which takes a seventh of the time of a step.
void keep_freed_memory();

/// Takes half a MiB of stack while address space is left.
///
/// The system extends the stack of the first thread page by page. Where no address space is left
/// for the next page a signal ends the process, and no message reports that memory ran out.
void take_stack();

}  // namespace firstcontact::app
