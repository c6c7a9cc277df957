#include "marey/pipeline/jobs/augment.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/format/register.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using pipeline::bodies::AugmentedAngle;
using pipeline::bodies::AugmentedPerson;

struct AugmentCommand {
  std::string recording;
  std::vector<std::string> outputs;
  pipeline::jobs::Augment job;
  bool json = false;
  bool quiet = false;
};

constexpr double kDegrees = 180 / std::numbers::pi;

void print_augmented(const AugmentCommand& command, const AugmentedPerson& person) {
  fmt::print(stderr, "{}: {} markers in {} of {} frames", command.recording, person.recording.tracks().size(), person.augmented,
             person.frames);
  if (person.marker_deviation_m) fmt::print(stderr, ", known to {:.0f} mm (median)", 1000 * *person.marker_deviation_m);
  fmt::print(stderr, "\n{:<28} {:>8} {:>8} {:>10}\n", "degrees", "lowest", "highest", "deviation");
  for (const AugmentedAngle& angle : person.angles) {
    const auto range = pipeline::bodies::range_of(angle);
    if (!range || (angle.name.find("_hip_") == std::string::npos && angle.name.find("_knee_") == std::string::npos &&
                   angle.name.find("_ankle_") == std::string::npos))
      continue;
    fmt::print(stderr, "{:<28} {:>8.1f} {:>8.1f} {:>10}\n", angle.name, kDegrees * range->lowest, kDegrees * range->highest,
               range->deviation ? fmt::format("{:.1f}", kDegrees * *range->deviation) : "");
  }
  for (const std::string& path : command.outputs) fmt::print(stderr, "written: {}\n", path);
  if (!command.job.angles.empty()) fmt::print(stderr, "written: {}\n", command.job.angles);
}

Json augmented_json(const AugmentCommand& command, const AugmentedPerson& person) {
  Json angles = Json::array();
  for (const AugmentedAngle& angle : person.angles) {
    const auto range = pipeline::bodies::range_of(angle);
    if (!range) continue;
    angles.push_back({{"name", angle.name},
                      {"lowest_deg", kDegrees * range->lowest},
                      {"highest_deg", kDegrees * range->highest},
                      {"deviation_deg", range->deviation ? Json(kDegrees * *range->deviation) : Json()}});
  }
  Json json = {{"frames", person.frames},
               {"augmented", person.augmented},
               {"markers", person.recording.tracks().size()},
               {"arms", person.arms},
               {"angles", angles},
               {"warnings", person.warnings}};
  if (person.marker_deviation_m) json["marker_deviation_mm"] = 1000 * *person.marker_deviation_m;
  if (!command.outputs.empty()) json["outputs"] = command.outputs;
  if (!command.job.angles.empty()) json["angles_output"] = command.job.angles;
  return json;
}

void run(const AugmentCommand& command) {
  const pipeline::bodies::AugmentOptions options = resolved(command.job);
  if (command.outputs.empty() && command.job.angles.empty())
    throw WrongUsage("{}", "give -o FILE for the markers, or --angles FILE.csv for the joints' angles");
  const AugmentedPerson person = with_progress(command.quiet, [&](const Hooks& hooks) {
    AugmentedPerson made = pipeline::bodies::augment_markers(command.recording, options, hooks);
    pipeline::bodies::write_augmented(made, command.outputs, command.job.angles);
    return made;
  });
  warn(person.warnings);
  if (command.json) {
    print(augmented_json(command, person));
  } else if (!command.quiet) {
    print_augmented(command, person);
  }
}

}  // namespace

void add_augment(Command& program) {
  auto options = std::make_shared<AugmentCommand>();
  Command command =
      program.subcommand("augment", "Anatomical markers and joint angles of body keypoints in space (OpenCap's marker augmenter)");
  command
      .input_file("RECORDING", options->recording, "body keypoints in space, as marey reconstruct --targets keypoints makes them")
      .required();
  command
      .texts("-o,--output", options->outputs,
             "the 43 markers, for marey solve and OpenSim, may be given often: .marey, .trc, .c3d, ...")
      .check([](const std::string& path) { format::format_to_write(path, {}, format::Content::space); });
  command.also_writes([options] { return options->outputs; });
  const pipeline::jobs::Table& rows = command.rows(table_of(options->job));
  command.records([&rows] { return rows.given(); });
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
