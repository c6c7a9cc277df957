#include "command_line.h"
#include "commands.h"
#include "simulate_ptz.h"

namespace marey::cli {

void add_simulate(Command& program) {
  Command simulate = program.subcommand("simulate", "Make a recording whose truth is known");
  add_simulate_markers(simulate);
  add_simulate_people(simulate);
  add_simulate_room(simulate);
  add_simulate_match(simulate);
  add_simulate_square(simulate);
  add_simulate_ptz(simulate);
}

}  // namespace marey::cli
