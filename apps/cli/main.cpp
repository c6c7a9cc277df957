extern "C" {
#include <libavutil/log.h>
}

#include "command_line.h"
#include "commands.h"

namespace marey::cli {

int run_program(int argc, char** argv) {
  av_log_set_level(AV_LOG_QUIET);  // what went wrong in a video is reported in our own sentences
  Program program("marey", "Marey turns what cameras see into motion you can measure.");
  Command root = program.root();
  add_track(root);
  add_detect(root);
  add_evaluate(root);
  add_measure(root);
  add_simulate(root);
  add_calibrate(root);
  add_convert(root);
  add_info(root);
  add_edit(root);
  add_identify(root);
  add_view(root);
  add_plan(root);
  add_play(root);
  add_reconstruct(root);
  add_live(root);
  add_cameras(root);
  add_node(root);
  add_solve(root);
  add_batch(root);
  add_doctor(root);
  add_completion(root);
  add_body(root);
  add_label(root);
  add_gait(root);
  add_moments(root);
  add_augment(root);
  add_experiment(root);
  return program.run(argc, argv);
}

}  // namespace marey::cli

int main(int argc, char** argv) {
  return marey::cli::run_program(argc, argv);
}
