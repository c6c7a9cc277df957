#pragma once

#include <CLI/CLI.hpp>

// The subcommands of `marey calibrate`, one short file each; see commands.h.
namespace marey::cli {

void add_calibrate_lens(CLI::App& calibrate);
void add_calibrate_pitch(CLI::App& calibrate);
void add_calibrate_wand(CLI::App& calibrate);
void add_calibrate_ground(CLI::App& calibrate);
void add_calibrate_board(CLI::App& calibrate);

}  // namespace marey::cli
