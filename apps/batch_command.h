/// @file
/// `firstcontact batch JOBS.jsonl -o RESULTS.jsonl`: many scenes, by all processors.

#pragma once

#include <CLI/CLI.hpp>

#include "exit_status.h"

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed, and leaves its status.
void add_batch_command(CLI::App& app, ExitStatus& status);

}  // namespace firstcontact::app
