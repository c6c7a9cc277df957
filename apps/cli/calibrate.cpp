#include "calibrate_commands.h"
#include "commands.h"

namespace marey::cli {

void add_calibrate(CLI::App& app) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "Find out how the cameras see: their lenses, and where they stand");
  calibrate->require_subcommand(1);
  add_calibrate_lens(*calibrate);
  add_calibrate_wand(*calibrate);
  add_calibrate_ground(*calibrate);
  add_calibrate_board(*calibrate);
  add_calibrate_pitch(*calibrate);
}

}  // namespace marey::cli
