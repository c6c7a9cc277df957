#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/calibrate/plan_room.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"
#include "scores.h"

namespace marey::cli {
namespace {

using pipeline::calibrate::PlanSummary;

struct PlanCommand {
  pipeline::calibrate::PlanOptions options;
  bool json = false, quiet = false;
};

Json coverage_json(const reconstruct::RoomCoverage& coverage) {
  return {{"covered", coverage.covered}, {"median_mm", 1000 * coverage.median_m}, {"p95_mm", 1000 * coverage.p95_m}};
}

Json summary_json(const PlanSummary& summary, const PlanCommand& command) {
  Json cameras = Json::array();
  for (const RigCamera& one : summary.planned.cameras) {
    const auto camera = one.camera();
    const Vector<3>& at = camera->centre();
    const Vector<3> ahead = camera->camera_from_world().rotation.row(2);
    cameras.push_back({{"name", one.name}, {"at", {at.x(), at.y(), at.z()}}, {"ahead", {ahead.x(), ahead.y(), ahead.z()}}});
  }
  Json json = {{"cameras", cameras},
               {"planned", coverage_json(summary.coverage)},
               {"rig", nullptr},
               {"reached", nullptr},
               {"warnings", summary.warnings},
               {"output", path_or_null(command.options.output)},
               {"plot", path_or_null(command.options.plot)}};
  if (summary.rig) json["rig"] = coverage_json(*summary.rig);
  if (summary.reached)
    json["reached"] = {{"points", summary.reached->points},
                       {"median_mm", 1000 * summary.reached->reached_m},
                       {"expected_mm", 1000 * summary.reached->expected_m},
                       {"noise_px", summary.reached->noise_px}};
  return json;
}

void print_coverage(const std::string& name, const reconstruct::RoomCoverage& coverage) {
  fmt::print("{:<22} {:>9}  {:>8.1f} mm {:>8.1f} mm\n", name, percent(coverage.covered), 1000 * coverage.median_m,
             1000 * coverage.p95_m);
}

void print_plan(const PlanSummary& summary, const PlanCommand& command) {
  fmt::print("camera        x       y       z   m      aimed at (degrees from x, up)\n");
  for (const RigCamera& one : summary.planned.cameras) {
    const auto camera = one.camera();
    const Vector<3> ahead = camera->camera_from_world().rotation.row(2);
    const double degrees = 180 / std::numbers::pi;
    fmt::print("{:<8} {:>7.2f} {:>7.2f} {:>7.2f}        {:>5.0f}, {:>3.0f}\n", one.name, camera->centre().x(), camera->centre().y(),
               camera->centre().z(), degrees * std::atan2(ahead.y(), ahead.x()), degrees * std::asin(ahead.z()));
  }
  fmt::print("\n{:<22} {:>9}  {:>11} {:>11}\n", "", "covered", "median", "95 %");
  print_coverage(fmt::format("planned, {} cameras", summary.planned.cameras.size()), summary.coverage);
  if (summary.rig) print_coverage(fmt::format("the rig, {} cameras", summary.rig_cameras), *summary.rig);
  if (summary.reached)
    fmt::print(
        "\n{} points of {}: {:.2f} mm in the median, where {:.2f} mm were expected at {} px of noise; {:.2f} px would explain it\n",
        summary.reached->points, command.options.recording, 1000 * summary.reached->reached_m, 1000 * summary.reached->expected_m,
        summary.room.noise_px, summary.reached->noise_px);
  for (const std::string& path : {command.options.output, command.options.plot}) {
    if (!path.empty()) fmt::print(stderr, "written: {}\n", path);
  }
}

void run_plan(const PlanCommand& command) {
  const PlanSummary summary =
      with_progress(command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::plan_room(command.options, hooks); });
  warn(summary.warnings);
  if (command.json) {
    print(summary_json(summary, command));
  } else if (!command.quiet) {
    print_plan(summary, command);
  }
}

}  // namespace

void add_plan(Command& program) {
  auto options = std::make_shared<PlanCommand>();
  pipeline::calibrate::PlanOptions& how = options->options;
  Command command = program.subcommand("plan", "Where to put cameras in a room, and how exact they will be");
  command
      .input_file("ROOM", how.room,
                  "room.toml: the volume in which people move, where cameras may be, how many there are (docs/plan.md)")
      .required();
  command.whole("--count", how.count, "N", 2, 64, "of cameras, in place of the room's");
  command.output_file("-o,--output", how.output, "a rig file with the planned cameras").ends_in({".toml"});
  command
      .output_file("--plot", how.plot,
                   "the room from above with its cameras, coverage and errors: FILE.svg; with --rig those of the rig")
      .ends_in({".svg"});
  command.input_file("--rig", how.rig, "a calibrated rig that is there: what it covers of the room");
  command.input_file("--recording", how.recording,
                     "what that rig made (a take): how exact its points are beside what was to be expected");
  command.reports(options->json, options->quiet);
  command.runs([options] { run_plan(*options); });
}

}  // namespace marey::cli
