#pragma once

// One short file a subcommand. Each declares its options and what runs, which throws marey::Error for what went wrong, WrongUsage
// where the command line asks for what cannot be, and EndWith for another exit code.
namespace marey::cli {

class Command;

/// All that `main` does: parses the words and runs the command that they name. Returns the exit code.
int run_program(int argc, char** argv);

void add_track(Command& program);
void add_detect(Command& program);
void add_evaluate(Command& program);
void add_measure(Command& program);
void add_reconstruct(Command& program);
void add_solve(Command& program);
void add_gait(Command& program);
void add_moments(Command& program);
void add_augment(Command& program);
void add_convert(Command& program);
void add_info(Command& program);
void add_edit(Command& program);
void add_view(Command& program);
void add_identify(Command& program);
void add_plan(Command& program);
void add_play(Command& program);
void add_live(Command& program);
void add_node(Command& program);
void add_cameras(Command& program);
void add_batch(Command& program);
void add_doctor(Command& program);
void add_completion(Command& program);
void add_body(Command& program);
void add_label(Command& program);

void add_simulate(Command& program);
void add_simulate_markers(Command& simulate);  ///< below `simulate`
void add_simulate_people(Command& simulate);
void add_simulate_match(Command& simulate);
void add_simulate_room(Command& simulate);
void add_simulate_square(Command& simulate);

void add_calibrate(Command& program);
void add_calibrate_lens(Command& calibrate);  ///< below `calibrate`
void add_calibrate_pitch(Command& calibrate);
void add_calibrate_wand(Command& calibrate);
void add_calibrate_people(Command& calibrate);
void add_calibrate_ground(Command& calibrate);
void add_calibrate_board(Command& calibrate);

void add_experiment(Command& program);
void add_experiment_trackers(Command& experiment);  ///< below `experiment`
void add_experiment_contours(Command& experiment);
void add_experiment_outlines(Command& experiment);
void add_experiment_hypotheses(Command& experiment);
void add_experiment_markers(Command& experiment);

}  // namespace marey::cli
