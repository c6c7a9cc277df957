#include "marey/pipeline/calibrate_board.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/rig_sources.h"

#include "calibrate_commands.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct CalibrateBoard {
  std::string rig, board, out;
  std::vector<std::string> sources;
  pipeline::BoardRunOptions run;
  bool json = false;
  bool quiet = false;
};

template <typename Figures>
nlohmann::json figures_of(const Figures& found) {
  return {{"mean_px", found.mean_px}, {"rms_px", found.rms_px}, {"inliers", found.inliers}, {"observations", found.observations}};
}

nlohmann::json as_json(const pipeline::BoardRun& run) {
  nlohmann::json cameras;
  for (std::size_t i = 0; i < run.rig.cameras.size(); ++i) {
    const calibrate::board::BoardRigPose& found = run.found.cameras[i];
    const Vector<3> centre = run.rig.cameras[i].camera_from_world->inverse().translation;
    nlohmann::json camera = figures_of(found);
    camera["centre"] = {centre.x(), centre.y(), centre.z()};
    camera["centre_deviation"] = {found.centre_deviation.x(), found.centre_deviation.y(), found.centre_deviation.z()};
    camera["offset_s"] = run.rig.cameras[i].offset_s.value_or(0);
    camera["offset_deviation_s"] = found.offset_deviation_s;
    camera["readout_s"] = found.readout_s;
    cameras[run.rig.cameras[i].name] = std::move(camera);
  }
  return {{"all", figures_of(run.found)}, {"cameras", cameras}, {"jitter_s", run.found.jitter_s}, {"warnings", run.found.warnings}};
}

void print_table(const pipeline::BoardRun& run) {
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
  Rig rig = format::rig::read_rig(command.rig);
  pipeline::set_sources(rig, command.sources);
  pipeline::BoardRunOptions options = command.run;
  pipeline::BoardRun found;
  {
    ProgressBar bar(command.quiet);
    options.progress = [&](const std::string& camera, std::int64_t done, std::optional<std::int64_t> all) {
      bar.show("looking for the board in " + camera, done, all);
    };
    found = pipeline::calibrate_board_from(rig, board, options);
  }
  format::rig::write_rig(found.rig, command.out);
  for (const std::string& sentence : found.found.warnings) fmt::print(stderr, "marey: warning: {}\n", sentence);
  if (command.json) {
    fmt::print("{}\n", as_json(found).dump(2));
  } else {
    print_table(found);
  }
}

}  // namespace

void add_calibrate_board(CLI::App& calibrate) {
  auto options = std::make_shared<CalibrateBoard>();
  CLI::App* command = calibrate.add_subcommand(
      "board", "Where the cameras stand, and how far they are out of step, from a board carried before them");
  command->add_option("rig", options->rig, "rig file: the cameras, their lenses where they are known")->required();
  command->add_option("sources", options->sources,
                      "CAMERA=VIDEO, CAMERA=FOLDER or CAMERA=PATTERN in place of the rig's own sources");
  command
      ->add_option("--board", options->board,
                   "chess:9x6:0.025 (inner corners, m) or charuco:COLSxROWS:SQUARE:MARKER:DICT, :inverted behind it where black "
                   "and white are exchanged")
      ->required();
  command->add_option("-o,--out", options->out, "rig file with what was found")->required();
  command->add_flag("--refine", options->run.refine, "refine the lenses too");
  command->add_flag("--synced", options->run.synced, "the cameras are in step: keep the rig's offsets");
  command->add_flag("--rolling-shutter", options->run.rolling_shutter,
                    "find out how long each shutter takes from the top row to the bottom row");
  command->add_option("--most-offset", options->run.most_offset_s, "how far the films may be out of step, s")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->add_flag("-q,--quiet", options->quiet, "no progress");
  command->callback([options] { run(*options); });
}

}  // namespace marey::cli
