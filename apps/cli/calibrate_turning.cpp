#include "calibrate_turning.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/format/rig/rig_turns.h"
#include "marey/pipeline/calibrate/calibrate_turning.h"

#include "command_line.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibrateTurning {
  std::string film, clicks, out;
  std::string size = "105x68";
  pipeline::calibrate::TurningRunOptions options;
  bool json = false;
  bool quiet = false;
};

constexpr double kDegrees = 180 / std::numbers::pi;

/// From where to where it turned and zoomed.
struct Turned {
  Vector<3> least = Vector<3>::Constant(1e9), most = Vector<3>::Constant(-1e9);
};

Turned turned(const TurningCamera& camera) {
  Turned result;
  for (const TurningCamera::Turn& turn : camera.turns) {
    if (!turn.heading) continue;
    result.least = result.least.cwiseMin(turn.heading->as_vector());
    result.most = result.most.cwiseMax(turn.heading->as_vector());
  }
  return result;
}

Json as_json(const pipeline::calibrate::TurningRun& run) {
  const geometry::Tripod& tripod = run.result.camera.tripod;
  Json frames = Json::array();
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    Json places = Json::array();
    for (std::size_t k = 0; k < run.clicks[i].places.size(); ++k)
      places.push_back({{"name", run.clicks[i].places[k].name}, {"error_px", run.clicked.error_px[i][k]}});
    frames.push_back({{"frame", run.clicks[i].frame}, {"clicks", places}});
  }
  return {{"frames", run.result.camera.turns.size()},
          {"lost", run.result.lost},
          {"cuts", run.result.cuts},
          {"found_again", run.result.found_again},
          {"paint_median_px", run.result.median_px},
          {"tripod", {tripod.place.x(), tripod.place.y(), tripod.place.z()}},
          {"seconds", run.seconds},
          {"clicked", frames},
          {"warnings", run.warnings}};
}

void print_report(const pipeline::calibrate::TurningRun& run, const std::string& out) {
  const TurningCamera& camera = run.result.camera;
  const Vector<2> place = (*run.rig.ground_from_world * camera.tripod.place.head<2>().homogeneous()).hnormalized();
  std::size_t clicks = 0;
  for (const auto& frame : run.clicks) clicks += frame.places.size();
  fmt::print("the tripod stands at ({:.1f}, {:.1f}), {:.1f} m up: {} clicks in {} frames, {:.1f} px off in the middle\n", place.x(),
             place.y(), camera.tripod.place.z(), clicks, run.clicks.size(), run.clicked.median_px);
  const Turned range = turned(camera);
  const double half = run.rig.cameras.front().size->width / 2.0;
  fmt::print("it turned by {:.1f} degrees, its focal length was {:.0f} to {:.0f} px\n",
             (range.most.x() - range.least.x()) * kDegrees, half * std::exp(range.least.z()), half * std::exp(range.most.z()));
  fmt::print("{} of {} frames are known; white lines are {:.2f} px off in the middle\n", std::ssize(camera.turns) - run.result.lost,
             camera.turns.size(), run.result.median_px);
  fmt::print("{} frames did not go on from the one before; {} times the camera was found again\n", run.result.cuts,
             run.result.found_again);
  fmt::print("{:.0f} frames a second\nrig: {}\n", static_cast<double>(camera.turns.size()) / std::max(1e-9, run.seconds), out);
}

void run(const CalibrateTurning& command) {
  pipeline::calibrate::TurningRunOptions options = command.options;
  options.follow.pitch = parse_pitch_size(command.size);
  const pipeline::calibrate::TurningRun found = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_turning(command.film, command.clicks, options, hooks);
  });
  format::rig::write_turning_rig(found.rig, {std::make_shared<const TurningCamera>(found.result.camera)}, command.out);
  warn(found.warnings);
  if (command.json) {
    print(as_json(found));
  } else if (!command.quiet) {
    print_report(found, command.out);
    if (!options.overlay.empty()) fmt::print("overlay: {}\n", options.overlay);
  }
}

}  // namespace

void add_calibrate_turning(Command& calibrate) {
  auto options = std::make_shared<CalibrateTurning>();
  Command command = calibrate.subcommand(
      "turning",
      "Where a camera over a football pitch looks that pans, tilts and zooms, from clicks in a few frames and the white lines");
  command.input_file("INPUT", options->film, "a film of one main camera").required();
  command
      .input_file("--points", options->clicks,
                  "clicked places in 2 to 4 frames that look to different sides: CSV frame,x,y,u,v, or CVAT XML")
      .required();
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  command.text("--name", options->options.name, "of the camera, in the rig");
  command.output_file("-o,--output", options->out, "rig file to write; where the camera looks is in a file beside it")
      .required()
      .ends_in({".toml", ".rig"});
  command.output_file("--overlay", options->options.overlay, "a film with the pitch's lines drawn into every frame: FILE.mp4")
      .ends_in({".mp4"});
  command.reports(options->json, options->quiet, "report");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
