/// @file
/// How the help of a command writes its options.

#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace firstcontact::app {

/// The options that an option needs or excludes stand in its text, as sentences do.
class HelpFormatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
  [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace firstcontact::app
