/// @file
/// Writes a planned path as a file that can be proven again (see docs/path_format.md).

#pragma once

#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct PlannedPath;

/// Writes a path as one JSON object on one line. Numbers read back to the same double.
///
/// @throws std::invalid_argument if a number is not finite
[[nodiscard]] FIRSTCONTACT_API std::string write_planned_path(const PlannedPath& path);

}  // namespace firstcontact
