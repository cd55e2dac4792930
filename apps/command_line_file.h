/// @file
/// Names of files on the command line.

#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// Adds an option that takes the name of a file. An empty one, such as of a shell's variable that
/// is not set, is refused: the option must not be lost in silence.
///
/// @param names  as CLI::App::add_option; errors go by the first
CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& description);

}  // namespace firstcontact::app
