#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/calibrate/ground.h"
#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/board_on_ground.h"
#include "marey/pipeline/camera_blobs.h"

#include "blob_options.h"
#include "board_option.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "progress_bar.h"
#include "rig_inputs.h"

namespace marey::cli {
namespace {

struct CalibrateGround {
  RigInputs inputs;
  std::string frame = "0,0;0.2,0;0.6,0;0,0.4";
  std::string board, out;
  detect::markers::MarkerOptions markers;
  bool scale = false;
  bool json = false;
  bool quiet = false;
};

std::vector<Vector<3>> frame_of(const std::string& text) {
  constexpr const char* form = "the markers' places on the ground in m, X,Y or X,Y,Z, with ; between them";
  std::vector<Vector<3>> frame;
  for (std::size_t at = 0; at <= text.size();) {
    const std::string part = text.substr(at, text.find(';', at) - at);
    const auto numbers = numbers_in(part, ',', closed(-1000, 1000), form);
    if (numbers.size() != 2 && numbers.size() != 3) throw WrongUsage("{}: write {}", part, form);
    frame.emplace_back(numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0);
    at += part.size() + 1;
  }
  return frame;
}

calibrate::GroundFound ground_of(const CalibrateGround& command, Rig& rig, ProgressBar& bar) {
  if (!command.board.empty()) return pipeline::board_on_ground(rig, calibrate::board::parse_board(command.board));
  pipeline::CameraBlobs blobs;
  if (!command.inputs.observations.empty()) {
    blobs = pipeline::read_blobs(command.inputs.observations, rig);
  } else {
    blobs =
        pipeline::find_blobs(rig, command.markers, [&](std::int64_t done) { bar.show("looking for markers", done, std::nullopt); });
  }
  for (const std::string& sentence : blobs.warnings) fmt::print(stderr, "marey: warning: {}\n", sentence);
  std::vector<std::vector<Vector<2>>> still;
  for (const auto& frames : blobs.seen) still.push_back(calibrate::still_blobs(frames));
  return calibrate::find_ground(rig, still, frame_of(command.frame), command.scale);
}

void run(const CalibrateGround& command) {
  Rig rig = rig_of(command.inputs);
  calibrate::GroundFound found;
  {
    ProgressBar bar(command.quiet);
    found = ground_of(command, rig, bar);
  }
  format::rig::write_rig(calibrate::moved_to_ground(rig, found.ground_from_world, found.scale), command.out);
  if (command.json) {
    print({{"rms_mm", found.rms_mm}, {"scale", found.scale}, {"seen_by", found.seen_by}});
  } else if (!command.quiet) {
    fmt::print("the ground fits to {:.2f} mm rms; its {} seen by {} to {} cameras\n", found.rms_mm,
               command.board.empty() ? "markers are" : "board is", *std::min_element(found.seen_by.begin(), found.seen_by.end()),
               *std::max_element(found.seen_by.begin(), found.seen_by.end()));
    if (command.scale) fmt::print("the rig is {:.4f} times as large as it was\n", found.scale);
    fmt::print("rig: {}\n", command.out);
  }
}

}  // namespace

void add_calibrate_ground(Command& calibrate) {
  auto options = std::make_shared<CalibrateGround>();
  Command command =
      calibrate.subcommand("ground", "Origin and axes of a calibrated rig, from an L-frame of markers or a board on the floor");
  Option rig = add_rig_inputs(command, options->inputs);
  Option frame =
      command.text("--frame", options->frame, "where the L-frame's markers lie: X,Y;X,Y;… in m").check([](const std::string& text) {
        frame_of(text);
      });
  add_board(command, options->board).excludes(frame);
  command.flag("--scale", options->scale, "the L-frame's size sets the rig's, as for a rig by a single light");
  command.output_file("-o,--output", options->out, "the rig file that is written").required().ends_in({".toml"}).may_replace(rig);
  add_threshold(command, options->markers.threshold);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
