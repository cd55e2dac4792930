/// @file
/// Reports on the text files that make up a scene.

#pragma once

#include <cstddef>
#include <filesystem>

#include <firstcontact/text/file_report.h>

namespace firstcontact {
struct Trajectory;
}

namespace firstcontact::detail {

/// The report on a scene or planning scene whose bodies another scene takes.
///
/// @param bodies  their number
[[nodiscard]] FileReport surroundings_report(const std::filesystem::path& file, const char* format,
                                             std::size_t bodies);

[[nodiscard]] FileReport trajectory_report(const std::filesystem::path& file,
                                           const Trajectory& trajectory);

}  // namespace firstcontact::detail
