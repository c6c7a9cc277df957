#include "marey/pipeline/markers/reconstruct.h"

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/jobs/reconstruct.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "reconstruct_keypoints.h"
#include "rig_inputs.h"
#include "run_hooks.h"
#include "set_figures.h"
#include "summary_figures.h"

namespace marey::cli {
namespace {

struct ReconstructCommand {
  RigInputs inputs;
  std::string out;
  bool of_keypoints = false;
  pipeline::jobs::ReconstructMarkers markers;
  pipeline::jobs::ReconstructKeypoints keypoints;
  bool json = false;
  bool quiet = false;
};

Json as_json(const pipeline::corridor::Summary& summary, const std::string& out) {
  const pipeline::corridor::SpacePointFigures points = summary.points.value_or(pipeline::corridor::SpacePointFigures{});
  Json json = {{"frames", summary.frames},
               {"seconds", summary.seconds},
               {"rate_hz", summary.rate_hz},
               {"markers", summary.tracks},
               {"labelled", summary.labelled},
               {"observations", points.observations},
               {"unexplained", points.unexplained},
               {"points", {{"measured", summary.measured}, {"filled", summary.filled}, {"predicted", summary.predicted}}},
               {"noise_px", points.noise_px},
               {"interrupted", summary.stopped},
               {"warnings", summary.warnings},
               {"take", out}};
  json["residual_px"] = points.residual_px ? Json(*points.residual_px) : Json();
  json["excluded"] = exclusions_of(summary);
  for (const auto& camera : summary.cameras) json["cameras"][camera.name] = {{"frames", camera.frames}, {"missed", camera.missed}};
  add_set_figures(summary, json);
  add_skeleton_figures(summary, json);
  json["stages"] = stages_of(summary);
  return json;
}

void print_points_summary(const pipeline::corridor::Summary& summary, const std::string& out) {
  const pipeline::corridor::SpacePointFigures points = summary.points.value_or(pipeline::corridor::SpacePointFigures{});
  fmt::print(stderr, "{} {} ({} with labels) in {} frames ({:.1f} s at {:g} Hz)\n", summary.tracks,
             summary.tracks == 1 ? "marker" : "markers", summary.labelled, summary.frames, summary.seconds, summary.rate_hz);
  fmt::print(stderr, "points: {} measured, {} filled, {} predicted; {} of {} blobs belong to no marker\n", summary.measured,
             summary.filled, summary.predicted, points.unexplained, points.observations);
  for (const pipeline::corridor::Exclusion& one : exclusions(summary)) {
    if (one.count > 0) fmt::print(stderr, "not placed, {} times: {}\n", one.count, one.description);
  }
  if (summary.measured > 0)
    fmt::print(stderr, "reprojection: {:.3f} px rms; noise of a blob {:.3f} px\n", points.residual_px.value_or(0), points.noise_px);
  print_set_figures(summary);
  print_skeleton_figures(summary);
  print_stages(summary);
  fmt::print(stderr, "take: {}\n", out);
}

void run_keypoints(const ReconstructCommand& command) {
  const pipeline::jobs::SpaceNames& names = command.markers.names;
  if (!command.inputs.observations.empty() || !names.labels.empty() || !names.set.empty() || !names.skeleton.empty())
    throw WrongUsage("{}",
                     "--targets keypoints: --observations, --labels, --marker-set and --skeleton are of markers; remove them");
  run_with_progress(
      command.quiet,
      [&](const Hooks& hooks) {
        return pipeline::keypoints::reconstruct_keypoints(rig_of(command.inputs), command.out, resolved(command.keypoints), hooks);
      },
      [&](const pipeline::keypoints::KeypointsSummary& summary, double) {
        if (command.json) {
          print(keypoints_json(summary, command.out));
        } else if (!command.quiet) {
          print_keypoints_summary(summary, command.out);
        }
      });
}

void run(const ReconstructCommand& command) {
  if (command.of_keypoints) return run_keypoints(command);
  std::vector<std::string> warnings;
  const pipeline::markers::MarkersInSpaceOptions options = resolved(command.markers, warnings);
  warn(warnings);
  run_with_progress(
      command.quiet,
      [&](const Hooks& hooks) {
        return pipeline::markers::reconstruct(rig_of(command.inputs), observations_of(command.inputs), command.out, options, hooks);
      },
      [&](const pipeline::corridor::Summary& summary, double) {
        if (command.json) {
          print(as_json(summary, command.out));
        } else if (!command.quiet) {
          print_points_summary(summary, command.out);
        }
      });
}

}  // namespace

void add_reconstruct(Command& program) {
  auto options = std::make_shared<ReconstructCommand>();
  Command command =
      program.subcommand("reconstruct", "Place and follow the markers, or people's keypoints, that several calibrated cameras see");
  add_rig_inputs(command, options->inputs);
  command.output_file("-o,--output", options->out, "what is written: a take, NAME.marey; or .c3d, .trc, .csv, .mcap")
      .required()
      .ends_in({".marey", ".c3d", ".trc", ".csv", ".mcap"});
  constexpr std::array<std::pair<const char*, bool>, 2> kTargets{{{"markers", false}, {"keypoints", true}}};
  command.choice(
      "--targets", options->of_keypoints, kTargets,
      "what is reconstructed: markers; or people's body keypoints, found in the cameras' videos, or read where CAMERA=FILE or "
      "CAMERA=FOLDER names them (OpenPose, COCO, AlphaPose, MMPose, DeepLabCut, SLEAP, takes of marey track)");
  const pipeline::jobs::Table& markers = command.rows(table_of(options->markers));
  const pipeline::jobs::Table& keypoints = command.rows(table_of(options->keypoints), "with --targets keypoints");
  command.records(
      [&markers, &keypoints, options = options.get()] { return (options->of_keypoints ? keypoints : markers).given(); });
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
