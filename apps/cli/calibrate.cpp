#include "calibrate_ptz.h"
#include "command_line.h"
#include "commands.h"

namespace marey::cli {

void add_calibrate(Command& program) {
  Command calibrate = program.subcommand("calibrate", "Find out how the cameras see: their lenses, and where they stand");
  add_calibrate_lens(calibrate);
  add_calibrate_wand(calibrate);
  add_calibrate_people(calibrate);
  add_calibrate_ground(calibrate);
  add_calibrate_board(calibrate);
  add_calibrate_pitch(calibrate);
  add_calibrate_ptz(calibrate);
}

}  // namespace marey::cli
