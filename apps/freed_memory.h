/// @file
/// What happens to memory that is freed.

#pragma once

namespace firstcontact::app {

/// Keeps what is freed for what is needed next: given back to the system, the tables of each step
/// of a simulation would be mapped in anew, page by page (a seventh of its time).
void keep_freed_memory();

}  // namespace firstcontact::app
