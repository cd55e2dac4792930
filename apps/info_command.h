/// @file
/// `firstcontact info FILE`: counts, defects and bounds of a mesh or point cloud.

#pragma once

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed.
void add_info_command(CLI::App& app);

}  // namespace firstcontact::app
