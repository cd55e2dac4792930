/// @file
/// The commands of a tool.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds each command of the tool; one of them runs while the command line is parsed.
///
/// `firstcontact` has all of them. The demonstration that runs during a build has `check` alone.
void add_commands(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
