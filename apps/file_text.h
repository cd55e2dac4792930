/// @file
/// What became of files, as people read it on a terminal.

#pragma once

#include <span>
#include <string>

#include <firstcontact/text/file_report.h>

namespace firstcontact::app {

/// "STL, 12 triangles, 8 vertices; lengths in 1 m"
[[nodiscard]] std::string contents_text(const FileReport& report);

/// "3 <material> (looks), 1 <gazebo> (settings of a simulator)"; empty where nothing was.
[[nodiscard]] std::string left_out_text(const FileReport& report);

/// A few lines for each file, indented by four.
[[nodiscard]] std::string describe_files(std::span<const FileReport> reports);

}  // namespace firstcontact::app
