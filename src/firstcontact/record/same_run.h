/// @file
/// Compares the header of a recorded run with that of a simulation.

#pragma once

#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/record/run.h>

namespace firstcontact {

/// Whether the header line of a run says what a header says.
///
/// Files count by their contents, which the digests of a header state. How their paths are spelled
/// does not count. So a run is the same by a relative path, by an absolute one or by a link.
///
/// @param line  the first line of a run, without its line feed
[[nodiscard]] FIRSTCONTACT_API bool is_header_line_of(std::string_view line,
                                                      const RunHeader& header);

}  // namespace firstcontact
