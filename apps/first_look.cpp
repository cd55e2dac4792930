// `check` alone needs two thirds of the library: the demonstration shows what it finds while the
// rest is compiled.

#include "check_command.h"
#include "commands.h"

namespace firstcontact::app {

void add_commands(CLI::App& app, ExitStatus& status) { add_check_command(app, status); }

}  // namespace firstcontact::app
