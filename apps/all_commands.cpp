#include "batch_command.h"
#include "check_command.h"
#include "commands.h"
#include "haptics_command.h"
#include "info_command.h"
#include "plan_command.h"
#include "retime_command.h"
#include "simulate_command.h"
#include "verify_command.h"
#include "view_command.h"

namespace firstcontact::app {

void add_commands(CLI::App& app, ExitStatus& status) {
  add_check_command(app, status);
  add_batch_command(app, status);
  add_plan_command(app, status);
  add_retime_command(app, status);
  add_simulate_command(app, status);
  add_haptics_command(app, status);
  add_verify_command(app, status);
  add_view_command(app);
  add_info_command(app);
}

}  // namespace firstcontact::app
