#include "marey/pipeline/jobs/solve.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "marey/format/register.h"
#include "marey/pipeline/bodies/solve_skeleton.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SolveCommand {
  std::string recording;
  std::vector<std::string> outputs;
  pipeline::jobs::Solve job;
  bool json = false;
  bool quiet = false;
};

using pipeline::bodies::SolveSummary;

constexpr std::ptrdiff_t kFreeBody = 6;  // what even one segment's markers show, if they are enough

std::string joined(const std::vector<std::string>& names, std::size_t maximum) {
  const auto shown = std::span(names).first(std::min(maximum, names.size()));
  return fmt::format("{}{}", fmt::join(shown, ", "),
                     names.size() > maximum ? fmt::format(" and {} more", names.size() - maximum) : "");
}

/// How well markers that are right lie, in words: OpenSim's own advice is 20 mm RMS. Few markers fit any skeleton.
std::string verdict(const SolveSummary& summary) {
  const std::string detected =
      fmt::format("{:.0f} of the skeleton's {} markers are seen in a frame", summary.markers_a_frame, summary.skeleton_markers);
  const auto observed = std::count_if(summary.coordinates.begin(), summary.coordinates.end(),
                                      [](const SolveSummary::Coordinate& coordinate) { return coordinate.observed >= 0.5; });
  if (observed < std::min<std::ptrdiff_t>(kFreeBody, std::ssize(summary.coordinates)))
    return fmt::format("that says nothing, {}, too few to show a pose", detected);
  if (summary.rms_m >= 0.020) return "poor: is the skeleton scaled to this person, and are the labels right?";
  const std::string word = summary.rms_m < 0.010 ? "good" : "fair";
  return 2 * summary.markers_a_frame < summary.skeleton_markers ? fmt::format("{}, but only {}", word, detected) : word;
}

void print_worst(const SolveSummary& summary) {
  std::vector<SolveSummary::Marker> by_rms = summary.markers;
  std::stable_sort(by_rms.begin(), by_rms.end(), [](const auto& a, const auto& b) { return a.rms_m > b.rms_m; });
  by_rms.resize(std::min<std::size_t>(3, by_rms.size()));
  std::vector<std::string> stated;
  for (const SolveSummary::Marker& marker : by_rms)
    stated.push_back(fmt::format("{} {:.1f} mm", marker.label, 1000 * marker.rms_m));
  fmt::print(stderr, "worst markers: {}\n", fmt::join(stated, ", "));
}

void print_solved(const std::string& recording, const SolveSummary& summary, const std::vector<std::string>& outputs) {
  fmt::print(stderr, "{}: the skeleton{}, solved from {} markers in {} {} ({:.1f} s at {:g} Hz)\n", recording,
             summary.skeleton.empty() ? "" : " " + summary.skeleton, summary.markers.size(), summary.frames,
             summary.frames == 1 ? "frame" : "frames", summary.seconds, summary.rate_hz);
  fmt::print(stderr, "markers lie {:.2f} mm RMS from where the skeleton has them (worst {:.1f} mm): {}\n", 1000 * summary.rms_m,
             1000 * summary.worst_m, verdict(summary));
  print_worst(summary);
  std::vector<std::string> hidden, at_times;
  for (const SolveSummary::Coordinate& coordinate : summary.coordinates) {
    if (coordinate.observed < 0.5) {
      hidden.push_back(coordinate.name);
    } else if (coordinate.observed < 1) {
      at_times.push_back(
          fmt::format("{} ({:.0f} % of the frames)", coordinate.name, std::max(1.0, 100 * (1 - coordinate.observed))));
    }
  }
  if (!hidden.empty()) fmt::print(stderr, "not observed, no marker shows them to 10°: {}\n", joined(hidden, 12));
  if (!at_times.empty()) fmt::print(stderr, "at times no marker shows these to 10°: {}\n", joined(at_times, 12));
  if (summary.overall_scale) {
    fmt::print(stderr, "calibrated: {:.3f} times as large as the skeleton was; markers lay {:.1f} mm RMS away before\n",
               *summary.overall_scale, 1000 * summary.rms_before_m);
    if (!summary.undetermined.empty())
      fmt::print(stderr, "sizes that the recording does not determine: {}\n", joined(summary.undetermined, 8));
    if (!summary.undetermined_markers.empty())
      fmt::print(stderr, "markers whose places it does not determine: {}\n", joined(summary.undetermined_markers, 8));
  }
  if (!summary.marker_set.empty()) fmt::print(stderr, "the human skeleton, by {}\n", summary.marker_set);
  for (const pipeline::bodies::FoundJoint& joint : summary.joints) fmt::print(stderr, "{}\n", joint.stated);
  if (summary.empty > 0) fmt::print(stderr, "{} frames have none of the markers; the pose is held there\n", summary.empty);
  if (summary.starts > 1) fmt::print(stderr, "lost and found again: {} times\n", summary.starts - 1);
  if (!summary.unused.empty()) fmt::print(stderr, "of the model, without effect on the pose: {}\n", summary.unused);
  if (!summary.not_recorded.empty())
    fmt::print(stderr, "the skeleton's markers that are not in the recording: {}\n", joined(summary.not_recorded, 8));
  if (!summary.not_known.empty()) fmt::print(stderr, "labels that the skeleton does not have: {}\n", joined(summary.not_known, 8));
  for (const std::string& path : outputs) fmt::print(stderr, "written: {}\n", path);
}

Json as_json(const SolveSummary& summary, const std::vector<std::string>& outputs) {
  Json markers = Json::array(), coordinates = Json::array(), joints = Json::array();
  for (const pipeline::bodies::FoundJoint& j : summary.joints) {
    const bool hinge = !j.name.ends_with("hip");
    const double unit = hinge ? 180 / std::numbers::pi : 1000;
    joints.push_back({{"name", j.name},
                      {"by_motion", j.by_motion},
                      {"unit", hinge ? "deg" : "mm"},
                      {"deviation", j.deviation * unit},
                      {"moved", j.moved * unit},
                      {"said", j.stated}});
  }
  for (const SolveSummary::Marker& m : summary.markers)
    markers.push_back({{"label", m.label}, {"seen", m.detected}, {"rms_mm", 1000 * m.rms_m}, {"worst_mm", 1000 * m.worst_m}});
  for (const SolveSummary::Coordinate& c : summary.coordinates) {
    const double unit = c.is_rotation ? 180 / std::numbers::pi : 1;
    coordinates.push_back({{"name", c.name},
                           {"unit", c.is_rotation ? "deg" : "m"},
                           {"lowest", c.lowest * unit},
                           {"highest", c.highest * unit},
                           {"deviation", c.deviation * unit},
                           {"observed", c.observed}});
  }
  return {{"skeleton", summary.skeleton},
          {"marker_set", summary.marker_set.empty() ? Json() : Json(summary.marker_set)},
          {"frames", summary.frames},
          {"frames_without_markers", summary.empty},
          {"rate_hz", summary.rate_hz},
          {"seconds", summary.seconds},
          {"skeleton_markers", summary.skeleton_markers},
          {"markers_a_frame", summary.markers_a_frame},
          {"rms_mm", 1000 * summary.rms_m},
          {"worst_mm", 1000 * summary.worst_m},
          {"initialisations", summary.starts},
          {"overall_scale", summary.overall_scale},
          {"sizes_not_determined", summary.undetermined},
          {"markers", markers},
          {"coordinates", coordinates},
          {"joints", joints},
          {"unused", summary.unused.empty() ? Json() : Json(summary.unused)},
          {"not_recorded", summary.not_recorded},
          {"not_known", summary.not_known},
          {"outputs", outputs},
          {"warnings", summary.warnings}};
}

void run(const SolveCommand& command) {
  const pipeline::bodies::SolveOptions options = resolved(command.job);
  const SolveSummary summary = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::bodies::solve_skeleton(command.recording, command.job.skeleton, command.outputs, options, hooks);
  });
  warn(summary.warnings);
  if (summary.stopped) {
    fmt::print(stderr, "marey: stopped after {} frames; nothing was written\n", summary.frames);
    throw EndWith{kInterrupted};
  }
  if (command.json) {
    print(as_json(summary, command.outputs));
  } else if (!command.quiet) {
    print_solved(command.recording, summary, command.outputs);
  }
}

}  // namespace

void add_solve(Command& program) {
  auto options = std::make_shared<SolveCommand>();
  Command command = program.subcommand("solve", "The motion of a skeleton, from labelled markers or body keypoints in space");
  command.input_file("RECORDING", options->recording, "labelled markers: " + format::names_of_read(format::Content::space))
      .required();
  command
      .texts("-o,--output", options->outputs,
             "what to write, may be given often: .mot or .sto (angles), .bvh or .glb (bones), or the recording with its bodies: "
             ".marey, .c3d, ...")
      .required()
      .check(pipeline::bodies::check_skeleton_output);
  command.also_writes([options] { return options->outputs; });
  const pipeline::jobs::Table& rows = command.rows(table_of(options->job));
  command.records([&rows] { return rows.given(); });
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
