/// @file
/// Writes a run as JSON Lines: a header, then one line for each step (see docs/run_format.md).

#pragma once

#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct RunHeader;
struct RunStep;

/// Writes the first line of a run, with its line feed. Numbers read back to the same double.
///
/// @throws std::invalid_argument if a number is not finite
[[nodiscard]] FIRSTCONTACT_API std::string write_run_header(const RunHeader& header);

/// Writes the line of a step, with its line feed. A line without it was not written whole.
///
/// @throws std::invalid_argument if a number is not finite, but for the clearance
[[nodiscard]] FIRSTCONTACT_API std::string write_run_step(const RunStep& step);

}  // namespace firstcontact
