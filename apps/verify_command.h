/// @file
/// `firstcontact verify FILE`: proves a run, or the result of a check, a second time.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed, and leaves its status.
void add_verify_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
