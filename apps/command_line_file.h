/// @file
/// Names of files on the command line.

#pragma once

#include <string>
#include <vector>

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

/// Adds an option that may be given several times, each time with the name of a file.
CLI::Option* add_files(CLI::App& command, const std::string& names, std::vector<std::string>& files,
                       const std::string& description);

}  // namespace firstcontact::app
