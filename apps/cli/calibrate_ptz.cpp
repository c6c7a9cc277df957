#include "calibrate_ptz.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_ptz.h"
#include "marey/pipeline/calibrate/calibrate_ptz.h"

#include "command_line.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibratePtz {
  std::string video, clicks, out;
  std::string size = "105x68", side;
  pipeline::calibrate::PtzRunOptions options;
  bool json = false;
  bool quiet = false;
};

constexpr double kDegrees = 180 / std::numbers::pi;

pipeline::calibrate::PtzSide side_named(const std::string& name) {
  if (name == "near") return pipeline::calibrate::PtzSide::near;
  if (name == "far") return pipeline::calibrate::PtzSide::far;
  throw Error("{}: near or far", name);
}

/// From where to where it turned and zoomed.
struct Rotated {
  Vector<3> minimum = Vector<3>::Constant(1e9), maximum = Vector<3>::Constant(-1e9);
};

Rotated rotated(const PtzCamera& camera) {
  Rotated result;
  for (const PtzCamera::Turn& turn : camera.rotations) {
    if (!turn.heading) continue;
    result.minimum = result.minimum.cwiseMin(turn.heading->as_vector());
    result.maximum = result.maximum.cwiseMax(turn.heading->as_vector());
  }
  return result;
}

Json as_json(const pipeline::calibrate::PtzRun& run) {
  const geometry::Tripod& tripod = run.result.camera.tripod;
  Json frames = Json::array();
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    Json locations = Json::array();
    for (std::size_t k = 0; k < run.clicks[i].locations.size(); ++k)
      locations.push_back({{"name", run.clicks[i].locations[k].name}, {"error_px", run.clicked.error_px[i][k]}});
    Json off = nullptr;
    bool contradicts = false;
    for (const auto& check : run.result.clicks) {
      if (check.frame == run.clicks[i].frame && check.off_px) off = *check.off_px, contradicts = check.contradicts;
    }
    frames.push_back({{"frame", run.clicks[i].frame}, {"clicks", locations}, {"result_px", off}, {"contradicts", contradicts}});
  }
  return {{"frames", run.result.camera.rotations.size()},
          {"lost", run.result.lost},
          {"cuts", run.result.cuts},
          {"reacquired", run.result.found_again},
          {"paint_median_px", run.result.median_px},
          {"tripod", {tripod.location.x(), tripod.location.y(), tripod.location.z()}},
          {"seconds", run.seconds},
          {"clicked", frames},
          {"searched", run.searched},
          {"warnings", run.warnings}};
}

void print_report(const pipeline::calibrate::PtzRun& run, const std::string& out) {
  const PtzCamera& camera = run.result.camera;
  const Vector<2> location = (*run.rig.ground_from_world * camera.tripod.location.head<2>().homogeneous()).hnormalized();
  std::size_t clicks = 0;
  for (const auto& frame : run.clicks) clicks += frame.locations.size();
  fmt::print("the tripod stands at ({:.1f}, {:.1f}), {:.1f} m up: ", location.x(), location.y(), camera.tripod.location.z());
  if (run.searched)
    fmt::print("by the lines of {} frames\n", run.clicks.size());
  else
    fmt::print("{} clicks in {} frames, {:.1f} px off in the middle\n", clicks, run.clicks.size(), run.clicked.median_px);
  const Rotated range = rotated(camera);
  const double half = run.rig.cameras.front().size->width / 2.0;
  fmt::print("it turned by {:.1f} degrees, its focal length was {:.0f} to {:.0f} px\n",
             (range.maximum.x() - range.minimum.x()) * kDegrees, half * std::exp(range.minimum.z()),
             half * std::exp(range.maximum.z()));
  fmt::print("{} of {} frames are known; white lines are {:.2f} px off in the middle\n",
             std::ssize(camera.rotations) - run.result.lost, camera.rotations.size(), run.result.median_px);
  fmt::print("{} frames did not continue from the one before; {} times the camera was found again\n", run.result.cuts,
             run.result.found_again);
  fmt::print("{:.0f} frames a second\nrig: {}\n", static_cast<double>(camera.rotations.size()) / std::max(1e-9, run.seconds), out);
}

void run(const CalibratePtz& command) {
  pipeline::calibrate::PtzRunOptions options = command.options;
  options.tracking.pitch = parse_pitch_size(command.size);
  if (!command.side.empty()) options.side = side_named(command.side);
  const pipeline::calibrate::PtzRun found = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_ptz(command.video, command.clicks, options, hooks);
  });
  format::rig::write_ptz_rig(found.rig, {std::make_shared<const PtzCamera>(found.result.camera)}, command.out);
  warn(found.warnings);
  if (command.json) {
    print(as_json(found));
  } else if (!command.quiet) {
    print_report(found, command.out);
    if (!options.overlay.empty()) fmt::print("overlay: {}\n", options.overlay);
  }
}

}  // namespace

void add_calibrate_ptz(Command& calibrate) {
  auto options = std::make_shared<CalibratePtz>();
  Command command = calibrate.subcommand(
      "ptz",
      "Where a camera over a football pitch looks that pans, tilts and zooms, from clicks in a few frames and the white lines");
  command.input_file("INPUT", options->video, "a video of one main camera").required();
  command.input_file("--points", options->clicks,
                     "clicked places in 2 to 4 frames turned to different sides: CSV frame,x,y,u,v, or CVAT XML (default: the "
                     "lines in the images alone)");
  command
      .text("--side", options->side,
            "without --points: near or far, whether the camera stands behind the touchline y = 0 or the other one; both fit alike")
      .check(side_named);
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  command.text("--name", options->options.name, "of the camera, in the rig");
  command.output_file("-o,--output", options->out, "rig file to write; where the camera looks is in a file beside it")
      .required()
      .ends_in({".toml", ".rig"});
  command.output_file("--overlay", options->options.overlay, "a video with the pitch's lines drawn into every frame: FILE.mp4")
      .ends_in({".mp4"});
  command.reports(options->json, options->quiet, "report");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
