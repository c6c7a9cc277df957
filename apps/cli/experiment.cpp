#include "command_line.h"
#include "commands.h"

namespace marey::cli {

void add_experiment(Command& program) {
  Command experiment = program.subcommand("experiment", "Repeat the experiments of the papers that Marey is built on");
  add_experiment_trackers(experiment);
  add_experiment_contours(experiment);
  add_experiment_outlines(experiment);
  add_experiment_hypotheses(experiment);
  add_experiment_markers(experiment);
}

}  // namespace marey::cli
