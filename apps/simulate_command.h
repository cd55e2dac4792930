/// @file
/// `firstcontact simulate`: bodies under forces and contacts, recorded step by step.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

void add_simulate_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
