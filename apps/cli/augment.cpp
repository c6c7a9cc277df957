#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/format/register.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/bodies/augment_markers.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using pipeline::bodies::AugmentedAngle;
using pipeline::bodies::AugmentedPerson;

struct AugmentCommand {
  std::string recording, output, angles;
  pipeline::bodies::AugmentOptions options;
  bool json = false;
  bool quiet = false;
};

constexpr double kDegrees = 180 / std::numbers::pi;

/// An angle's range and its typical deviation, degrees; nothing if it is nowhere known.
struct AngleFigures {
  double lowest = 0, highest = 0;
  std::optional<double> deviation;
};

std::optional<AngleFigures> figures_of(const AugmentedAngle& angle) {
  std::vector<double> values, deviations;
  for (const auto& value : angle.values) {
    if (value) values.push_back(*value * kDegrees);
  }
  for (const auto& deviation : angle.deviations) {
    if (deviation) deviations.push_back(*deviation * kDegrees);
  }
  if (values.empty()) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return AngleFigures{*lowest, *highest, deviations.empty() ? std::nullopt : std::optional(geometry::median(deviations))};
}

void print_augmented(const AugmentCommand& command, const AugmentedPerson& person) {
  fmt::print(stderr, "{}: {} markers in {} of {} frames", command.recording, person.recording.tracks().size(), person.augmented,
             person.frames);
  if (person.marker_deviation_m) fmt::print(stderr, ", known to {:.0f} mm (median)", 1000 * *person.marker_deviation_m);
  fmt::print(stderr, "\n{:<28} {:>8} {:>8} {:>10}\n", "degrees", "lowest", "highest", "deviation");
  for (const AugmentedAngle& angle : person.angles) {
    const auto figures = figures_of(angle);
    if (!figures || (angle.name.find("_hip_") == std::string::npos && angle.name.find("_knee_") == std::string::npos &&
                     angle.name.find("_ankle_") == std::string::npos))
      continue;
    fmt::print(stderr, "{:<28} {:>8.1f} {:>8.1f} {:>10}\n", angle.name, figures->lowest, figures->highest,
               figures->deviation ? fmt::format("{:.1f}", *figures->deviation) : "");
  }
  for (const std::string* path : {&command.output, &command.angles}) {
    if (!path->empty()) fmt::print(stderr, "written: {}\n", *path);
  }
}

Json augmented_json(const AugmentCommand& command, const AugmentedPerson& person) {
  Json angles = Json::array();
  for (const AugmentedAngle& angle : person.angles) {
    if (const auto figures = figures_of(angle))
      angles.push_back({{"name", angle.name},
                        {"lowest_deg", figures->lowest},
                        {"highest_deg", figures->highest},
                        {"deviation_deg", figures->deviation}});
  }
  Json json = {{"frames", person.frames},
               {"augmented", person.augmented},
               {"markers", person.recording.tracks().size()},
               {"arms", person.arms},
               {"angles", angles},
               {"warnings", person.warnings}};
  if (person.marker_deviation_m) json["marker_deviation_mm"] = 1000 * *person.marker_deviation_m;
  if (!command.output.empty()) json["output"] = command.output;
  if (!command.angles.empty()) json["angles_output"] = command.angles;
  return json;
}

void run(AugmentCommand& command) {
  if (command.output.empty() && command.angles.empty())
    throw WrongUsage("{}", "give -o FILE for the markers, or --angles FILE.csv for the joints' angles");
  const AugmentedPerson person = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::bodies::augment_markers(command.recording, command.output, command.angles, command.options, hooks);
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
  command.number("--height", options->options.height_m, "m", {0.5, 2.6}, "the person's height").required();
  command.number("--mass", options->options.mass_kg, "kg", {2, 500}, "the person's mass").required();
  command.output_file("-o,--output", options->output, "the 43 markers, for marey solve and OpenSim: .marey, .trc, .c3d, ...");
  command.output_file("--angles", options->angles, "angles of hips, knees, ankles, ... with one standard deviation, degrees")
      .ends_in({".csv"});
  command.text("--person", options->options.person, "of several people the one: P2; omitted: the first");
  using pipeline::keypoints::HipPoints;
  constexpr std::array<std::pair<const char*, HipPoints>, 2> kHips{
      {{"keypoints", HipPoints::as_networks}, {"joints", HipPoints::joint_centres}}};
  command.choice("--hips", options->options.hips, kHips,
                 "what the recording's hips are: as networks for keypoints have them, or the joints' centres, as a simulation or a "
                 "marker-based model has them");
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice("--up", options->options.up, kAxes, "the axis that is up in RECORDING; as it says where this is omitted, else z");
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
