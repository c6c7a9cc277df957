#pragma once

#include <CLI/CLI.hpp>

// One short file a subcommand. Each adds itself to the program, with its options and the callback that runs it; the callback
// throws marey::Error for what went wrong, and CLI::RuntimeError for another exit code.
namespace marey::cli {

void add_track(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_simulate(CLI::App& app);
void add_simulate_people(CLI::App& simulate);  ///< below `simulate`
void add_simulate_match(CLI::App& simulate);   ///< below `simulate`
void add_simulate_room(CLI::App& simulate);    ///< below `simulate`
void add_reconstruct(CLI::App& app);
void add_experiment(CLI::App& app);
void add_measure(CLI::App& app);
void add_experiment_outlines(CLI::App& experiment);  ///< below `experiment`
void add_experiment_hypotheses(CLI::App& experiment);
void add_calibrate(CLI::App& app);
void add_convert(CLI::App& app);
void add_info(CLI::App& app);

}  // namespace marey::cli
