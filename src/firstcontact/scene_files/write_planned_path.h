/// @file
/// Writes a planned path as a file that can be proven again (see docs/path_format.md).

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

struct PathSource;
struct PlannedPath;

/// Writes a path as one JSON object on one line. Numbers read back to the same double.
///
/// @throws std::invalid_argument if a number is not finite
[[nodiscard]] FIRSTCONTACT_API std::string write_planned_path(const PlannedPath& path);

/// Reads files for PlannedPath::sources; each file once.
///
/// @throws ParseError  names a file that cannot be read
[[nodiscard]] FIRSTCONTACT_API std::vector<PathSource> path_sources(
    const std::vector<std::filesystem::path>& files);

}  // namespace firstcontact
