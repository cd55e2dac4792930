/// @file
/// `firstcontact retime PATH`: a path as a trajectory that is proven as its controller executes it.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed.
void add_retime_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
