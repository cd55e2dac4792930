/// @file
/// The text of options in the help of a command.

#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// Writes options; those that an option needs or excludes appear in its text, as sentences.
class HelpFormatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
  [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace firstcontact::app
