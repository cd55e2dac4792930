/// @file
/// Numbers on the command line, read as strictly as in a scene.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace firstcontact::app {

enum class Range { positive, not_negative };

/// Adds an option that takes one number: finite, in range, with a decimal point in every locale.
CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& number,
                        Range range, const std::string& description);

/// Adds an option that takes one number from `least` to `greatest`, read as by add_number().
CLI::Option* add_number_between(CLI::App& command, const std::string& name,
                                std::optional<double>& number, double least, double greatest,
                                const std::string& description);

/// Adds an option that takes a whole number > 0.
CLI::Option* add_count(CLI::App& command, const std::string& name, std::size_t& count,
                       const std::string& description);

/// Adds an option that takes a whole number > 0, or is left out.
CLI::Option* add_count(CLI::App& command, const std::string& name,
                       std::optional<std::size_t>& count, const std::string& description);

/// Adds --threads, which takes 0 to 1024.
///
/// @param same  the thing that does not depend on their number: "The answer"
CLI::Option* add_threads(CLI::App& command, int& threads, const std::string& same);

}  // namespace firstcontact::app
