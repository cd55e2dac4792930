/// @file
/// firstcontact plan: a path that is proven edge by edge.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

void add_plan_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
