// The command line tool: parse, call, print.

#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <firstcontact/scene/version.h>
#include <firstcontact/text/json_reader.h>

#include "commands.h"
#include "exit_status.h"
#include "freed_memory.h"
#include "help_formatter.h"
#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

/// Prints an error on one line, wherever it comes from.
void complain(std::string message) {
  for (char& c : message) {
    c = c == '\n' || c == '\r' ? ' ' : c;
  }
  say_on_stderr("firstcontact: " + visible(message) + '\n');
}

std::string_view nearest(std::string_view word, const std::vector<std::string>& known) {
  return detail::nearest_word(word, {known.begin(), known.end()});
}

/// Suggests an option in place of an unknown one: "; did you mean --margin?".
std::string meant_option(const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_group().empty()) {
      std::ranges::copy(option->get_lnames(), std::back_inserter(known));
    }
  }
  for (const std::string& rest : command.remaining()) {
    if (rest.starts_with("--")) {
      const std::string_view near = nearest(rest.substr(2, rest.find('=') - 2), known);
      return near.empty() ? "" : fmt::format("; did you mean --{}?", near);
    }
  }
  return {};
}

/// Describes an error, with the help to read: that of the command, where the first argument is one.
std::string describe(const CLI::ParseError& error, const CLI::App& app, const std::string& first) {
  const auto is_first = [&first](const CLI::App* command) { return command->get_name() == first; };
  if (const auto found = app.get_subcommands(is_first); !found.empty()) {
    return fmt::format("{}{} (see firstcontact {} --help)", error.what(),
                       meant_option(*found.front()), first);
  }
  if (first.empty() || first[0] == '-' || !app.get_subcommands().empty()) {
    return std::string(error.what()) + " (see firstcontact --help)";
  }
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(command->get_name());
  }
  const std::string_view near = nearest(first, commands);
  return fmt::format("unknown command \"{}\"{} (see firstcontact --help)", first,
                     near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
}

ExitStatus run(int argc, char** argv) {
  ExitStatus status = kSuccess;
  CLI::App app("When do moving bodies touch for the first time? Proven, not sampled.",
               "firstcontact");
  app.set_version_flag("--version", std::string("firstcontact ") + version());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());  // The commands inherit it.
  add_commands(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // For help or version.
      app.exit(error);
      flush_stdout();
      return kSuccess;
    }
    complain(describe(error, app, argc > 1 ? argv[1] : ""));
    return ExitStatus::bad_input;
  }
  return status;
}

}  // namespace
}  // namespace firstcontact::app

int main(int argc, char** argv) {
  using firstcontact::app::ExitStatus;
  firstcontact::app::occupy_closed_streams();
  firstcontact::app::refuse_long_files_by_error();
  firstcontact::app::keep_freed_memory();
  firstcontact::app::take_stack();
  try {
    return static_cast<int>(firstcontact::app::run(argc, argv));
  } catch (const std::bad_alloc&) {
    firstcontact::app::complain("not enough memory");
  } catch (const std::exception& error) {
    firstcontact::app::complain(error.what());
  }
  return static_cast<int>(ExitStatus::bad_input);
}
