#include "marey/pipeline/calibrate/calibrate_board.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/format/rig/rig_file.h"

#include "board_option.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "rig_inputs.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibrateBoard {
  RigAndSources inputs;
  std::string board, out;
  pipeline::calibrate::BoardRunOptions run;
  bool json = false;
  bool quiet = false;
};

template <typename Figures>
Json figures_of(const Figures& found) {
  return {{"mean_px", found.mean_px}, {"rms_px", found.rms_px}, {"inliers", found.inliers}, {"observations", found.observations}};
}

Json as_json(const pipeline::calibrate::BoardRun& run) {
  Json cameras;
  for (std::size_t i = 0; i < run.rig.cameras.size(); ++i) {
    const calibrate::board::BoardRigPose& found = run.found.cameras[i];
    const Vector<3> centre = run.rig.cameras[i].camera_from_world->inverse().translation;
    Json camera = figures_of(found);
    camera["centre"] = {centre.x(), centre.y(), centre.z()};
    camera["centre_deviation"] = {found.centre_deviation.x(), found.centre_deviation.y(), found.centre_deviation.z()};
    camera["offset_s"] = run.rig.cameras[i].offset_s.value_or(0);
    camera["offset_deviation_s"] = found.offset_deviation_s;
    camera["readout_s"] = found.readout_s;
    cameras[run.rig.cameras[i].name] = std::move(camera);
  }
  return {{"all", figures_of(run.found)}, {"cameras", cameras}, {"jitter_s", run.found.jitter_s}, {"warnings", run.found.warnings}};
}

void print_table(const pipeline::calibrate::BoardRun& run) {
  fmt::print("{:<14} {:>8} {:>8} {:>13} {:>9} {:>26}\n", "camera", "RMS px", "mean px", "corners", "offset ms", "centre m");
  for (std::size_t i = 0; i < run.rig.cameras.size(); ++i) {
    const calibrate::board::BoardRigPose& found = run.found.cameras[i];
    const Vector<3> centre = run.rig.cameras[i].camera_from_world->inverse().translation;
    fmt::print("{:<14} {:>8.3f} {:>8.3f} {:>13} {:>9.2f} {:>8.4f} {:>8.4f} {:>8.4f}\n", run.rig.cameras[i].name, found.rms_px,
               found.mean_px, fmt::format("{}/{}", found.inliers, found.observations),
               1e3 * run.rig.cameras[i].offset_s.value_or(0), centre.x(), centre.y(), centre.z());
  }
  fmt::print("{:<14} {:>8.3f} {:>8.3f} {:>13}\n", "all", run.found.rms_px, run.found.mean_px,
             fmt::format("{}/{}", run.found.inliers, run.found.observations));
}

void run(const CalibrateBoard& command) {
  const calibrate::board::Board board = calibrate::board::parse_board(command.board);
  const Rig rig = rig_of(command.inputs);
  const pipeline::calibrate::BoardRun found = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_board(rig, board, command.run, hooks); });
  format::rig::write_rig(found.rig, command.out);
  warn(found.found.warnings);
  if (command.json) {
    print(as_json(found));
  } else if (!command.quiet) {
    print_table(found);
    fmt::print("rig: {}\n", command.out);
  }
}

}  // namespace

void add_calibrate_board(Command& calibrate) {
  auto options = std::make_shared<CalibrateBoard>();
  Command command = calibrate.subcommand(
      "board", "Where the cameras stand, and how far they are unsynchronised, from a board carried before them");
  Option rig = add_rig(command, options->inputs, "rig file: the cameras, their lenses where they are known").required();
  add_board(command, options->board).required();
  command.output_file("-o,--output", options->out, "rig file with what was found").required().ends_in({".toml"}).may_replace(rig);
  command.flag("--refine", options->run.refine, "refine the lenses too");
  command.flag("--synced", options->run.synced, "the cameras are synchronised: keep the rig's offsets");
  command.flag("--rolling-shutter", options->run.rolling_shutter,
               "find out how long each shutter takes from the top row to the bottom row");
  command.number("--max-offset", options->run.max_offset_s, "s", closed(0, 3600), "how far the videos may be unsynchronised");
  command.reports(options->json, options->quiet, "table");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
