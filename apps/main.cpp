// The command line tool: parse, call, print.

#include <exception>
#include <new>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <firstcontact/scene/version.h>

#include "commands.h"
#include "exit_status.h"
#include "freed_memory.h"
#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

/// Errors are one line, wherever they come from.
void complain(std::string message) {
  for (char& c : message) {
    c = c == '\n' || c == '\r' ? ' ' : c;
  }
  say_on_stderr("firstcontact: " + visible(message) + '\n');
}

/// With the help to look at: that of the command, where the first argument is one.
std::string describe(const CLI::ParseError& error, const CLI::App& app, const std::string& first) {
  const auto is_first = [&first](const CLI::App* command) { return command->get_name() == first; };
  if (!app.get_subcommands(is_first).empty()) {
    return fmt::format("{} (see firstcontact {} --help)", error.what(), first);
  }
  const bool unknown = !first.empty() && first[0] != '-' && app.get_subcommands().empty();
  return (unknown ? fmt::format("unknown command \"{}\"", first) : std::string(error.what())) +
         " (see firstcontact --help)";
}

ExitStatus run(int argc, char** argv) {
  ExitStatus status = kSuccess;
  CLI::App app("When do moving bodies touch for the first time? Proven, not sampled.",
               "firstcontact");
  app.set_version_flag("--version", std::string("firstcontact ") + version());
  app.require_subcommand(1);
  add_commands(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // Help or version was asked for.
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
