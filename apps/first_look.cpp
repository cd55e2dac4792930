// The tool with `check` alone, which needs neither planning, simulation, haptics nor second proofs.
// The demonstration shows its results before these are compiled.

#include "check_command.h"
#include "commands.h"

namespace firstcontact::app {

void add_commands(CLI::App& app, ExitStatus& status) { add_check_command(app, status); }

}  // namespace firstcontact::app
