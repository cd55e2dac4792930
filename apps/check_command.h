/// @file
/// `firstcontact check SCENE...`: first contact of the bodies in scenes.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed, and leaves its status.
void add_check_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
