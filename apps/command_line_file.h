/// @file
/// Names of files on the command line.

#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// Adds an option that takes the name of a file.
///
/// An empty name, such as that of an unset shell variable, is refused: the option must not be lost
/// in silence.
///
/// @param names  as for CLI::App::add_option; errors name the first
CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& description);

}  // namespace firstcontact::app
