/// @file
/// The command `haptics`.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; running it sets the status.
void add_haptics_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
