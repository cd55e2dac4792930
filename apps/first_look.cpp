// `check` alone needs neither planning, simulation, haptics nor second proofs: the demonstration
// shows what it finds before these are compiled.

#include "check_command.h"
#include "commands.h"

namespace firstcontact::app {

void add_commands(CLI::App& app, ExitStatus& status) { add_check_command(app, status); }

}  // namespace firstcontact::app
