/// @file
/// Reports on files as text for a terminal.

#pragma once

#include <span>
#include <string>

#include <firstcontact/text/file_report.h>

namespace firstcontact::app {

/// The contents of a file as text: "STL, 12 triangles, 8 vertices; lengths in 1 m".
[[nodiscard]] std::string contents_text(const FileReport& report);

/// The names left out as text: "3 <material> (looks), 1 <gazebo> (settings of a simulator)"; empty
/// where there are none.
[[nodiscard]] std::string left_out_text(const FileReport& report);

/// Describes each file in a few lines, indented by four.
[[nodiscard]] std::string describe_files(std::span<const FileReport> reports);

}  // namespace firstcontact::app
