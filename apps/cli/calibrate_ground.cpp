#include "marey/pipeline/calibrate/calibrate_ground.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/jobs/detection_rows.h"

#include "board_option.h"
#include "command_line.h"
#include "commands.h"
#include "ground_frame.h"
#include "json_value.h"
#include "rig_inputs.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibrateGround {
  RigInputs inputs;
  std::string frame = kDefaultGroundFrame;
  std::string board, out;
  pipeline::calibrate::CalibrateGroundOptions options;
  bool json = false;
  bool quiet = false;
};

void run(const CalibrateGround& command) {
  pipeline::calibrate::CalibrateGroundOptions options = command.options;
  if (!command.board.empty()) options.board = calibrate::board::parse_board(command.board);
  options.frame = ground_frame_of(command.frame);
  options.observations = observations_of(command.inputs);
  const pipeline::calibrate::GroundCalibration result = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_ground(rig_of(command.inputs), options, hooks);
  });
  const calibrate::GroundFound& found = result.found;
  warn(result.warnings);
  format::rig::write_rig(result.rig, command.out);
  if (command.json) {
    print({{"rms_mm", found.rms_mm}, {"scale", found.scale}, {"seen_by", found.observed_by}});
  } else if (!command.quiet) {
    const auto [minimum, maximum] = std::minmax_element(found.observed_by.begin(), found.observed_by.end());
    fmt::print("the ground fits to {:.2f} mm rms; its {} seen by {} to {} cameras\n", found.rms_mm,
               command.board.empty() ? "markers are" : "board is", *minimum, *maximum);
    if (options.scale) fmt::print("the rig is {:.4f} times as large as it was\n", found.scale);
    fmt::print("rig: {}\n", command.out);
  }
}

}  // namespace

void add_calibrate_ground(Command& calibrate) {
  auto options = std::make_shared<CalibrateGround>();
  Command command =
      calibrate.subcommand("ground", "Origin and axes of a calibrated rig, from an L-frame of markers or a board on the floor");
  Option rig = add_rig_inputs(command, options->inputs);
  Option frame = add_ground_frame(command, options->frame, "where the L-frame's markers lie: X,Y;X,Y;… in m");
  add_board(command, options->board).excludes(frame);
  command.flag("--scale", options->options.scale, "the L-frame's size sets the rig's, as for a rig by a single light");
  command.output_file("-o,--output", options->out, "the rig file that is written").required().ends_in({".toml"}).may_replace(rig);
  pipeline::jobs::Table rows;
  add_threshold_row(rows, options->options.markers.threshold);
  command.rows(std::move(rows));
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
