/// @file
/// `firstcontact view RESULT`: the page that plays a result or a run.

#pragma once

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// Adds the command; it runs while the command line is parsed.
void add_view_command(CLI::App& app);

}  // namespace firstcontact::app
