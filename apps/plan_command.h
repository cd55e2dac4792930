/// @file
/// firstcontact plan: a path that is proven edge by edge.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed, and leaves its status.
void add_plan_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
