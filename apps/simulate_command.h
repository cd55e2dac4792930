/// @file
/// `firstcontact simulate`: bodies under forces and contacts, recorded step by step.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed, and leaves its status.
void add_simulate_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
