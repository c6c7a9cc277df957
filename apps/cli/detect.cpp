#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/markers/detect_markers.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct DetectCommand {
  RigCamera input;
  pipeline::markers::BlobOutput output;
  pipeline::jobs::MarkerDetection markers;
  bool json = false;
  bool quiet = false;
};

/// What the detector omitted, with its reason, where there is any.
std::vector<std::pair<const char*, std::int64_t>> excluded(const detect::markers::MarkerCounts& counts) {
  std::vector<std::pair<const char*, std::int64_t>> reasons{{"smaller than --min-area", counts.too_small},
                                                            {"larger than --max-area", counts.too_large},
                                                            {"less round than --min-roundness", counts.not_round},
                                                            {"unlike the markers beside them", counts.unlike},
                                                            {"beyond --max-markers", counts.over_limit}};
  std::erase_if(reasons, [](const auto& reason) { return reason.second == 0; });
  return reasons;
}

void print_blob_summary(const DetectCommand& command, const pipeline::markers::BlobSummary& summary) {
  const auto frames = static_cast<double>(std::max<std::int64_t>(1, summary.frames));
  fmt::print(stderr, "{} {} in {} {}, {:.1f} an image, at most {}; {:.2f} ms an image\n", summary.blobs,
             summary.blobs == 1 ? "marker" : "markers", summary.frames, summary.frames == 1 ? "image" : "images",
             static_cast<double>(summary.blobs) / frames, summary.maximum, 1000 * summary.detect_s / frames);
  fmt::print(stderr, "threshold: {:.0f} grey levels above what is around, noise {:.1f}\n", summary.threshold, summary.noise);
  for (const auto& [reason, count] : excluded(summary.counts)) fmt::print(stderr, "omitted: {} {}\n", count, reason);
  if (summary.counts.masked_fraction > 0)
    fmt::print(stderr, "masked: {:.1f} % of the image\n", 100 * summary.counts.masked_fraction);
  if (!command.output.blobs.empty()) fmt::print(stderr, "blobs: {}\n", command.output.blobs);
  if (!command.output.overlay.empty()) fmt::print(stderr, "overlay: {}\n", command.output.overlay);
}

void print_blob_json(const DetectCommand& command, const pipeline::markers::BlobSummary& summary, double elapsed) {
  Json json = {{"frames", summary.frames},       {"markers", summary.blobs},
               {"most", summary.maximum},        {"seconds", summary.seconds},
               {"detect_s", summary.detect_s},   {"elapsed", elapsed},
               {"threshold", summary.threshold}, {"noise", summary.noise},
               {"split", summary.counts.split},  {"masked_share", summary.counts.masked_fraction},
               {"stopped", summary.stopped},     {"warnings", summary.warnings},
               {"blobs", command.output.blobs},  {"overlay", path_or_null(command.output.overlay)}};
  const detect::markers::MarkerCounts& counts = summary.counts;
  json["left_out"] = {{"too_small", counts.too_small},
                      {"too_large", counts.too_large},
                      {"not_round", counts.not_round},
                      {"unlike", counts.unlike},
                      {"over_limit", counts.over_limit}};
  print(json);
}

std::string default_blobs(const std::string& input) {
  const std::filesystem::path given = input;
  std::string stem = (given.has_filename() ? given : given.parent_path()).stem().string();
  std::erase_if(stem, [](char c) { return c == '*' || c == '?' || c == '%'; });
  return (stem.empty() || stem == "." || stem == ".." ? "video" : stem) + "_blobs.csv";
}

void run_detect(DetectCommand command) {
  if (command.output.blobs.empty()) command.output.blobs = default_blobs(command.input.source);
  if (command.output.blobs == "-") command.output.blobs = "/dev/stdout";
  const detect::markers::MarkerOptions options = detector_of(command.markers);
  run_with_progress(
      command.quiet,
      [&](const Hooks& hooks) { return pipeline::markers::detect_markers(command.input, command.output, options, hooks); },
      [&](const pipeline::markers::BlobSummary& summary, double elapsed) {
        if (command.json) {
          print_blob_json(command, summary, elapsed);
        } else if (!command.quiet) {
          print_blob_summary(command, summary);
        }
      });
}

}  // namespace

void add_detect(Command& program) {
  auto options = std::make_shared<DetectCommand>();
  Command command = program.subcommand("detect", "Find markers in images or videos without following them");
  command
      .input_file("INPUT", options->input.source,
                  "an image, a folder of images, a pattern such as 'shot_%04d.png', or a video file")
      .required();
  command.number("--rate", options->input.rate_hz, "Hz", kRates, "frames a second, where the file does not specify or is wrong");
  command.text("--camera", options->input.name, "what the camera is called in the output (default: camera)");
  command.output_file("-o,--output", options->output.blobs,
                      "where the blobs go, CSV or NAME.jsonl; - for standard output (default: INPUT_blobs.csv in this folder)");
  command
      .output_file("--overlay", options->output.overlay,
                   "the blobs drawn into the images: FILE.mp4; of one image, or the first, FILE.png or FILE.jpg")
      .ends_in({".mp4", ".png", ".jpg", ".jpeg"});
  command.also_writes([options]() -> std::vector<std::string> {
    if (!options->output.blobs.empty()) return {};
    return {default_blobs(options->input.source)};
  });
  command.reports(options->json, options->quiet);
  pipeline::jobs::Table rows;
  add_marker_rows(rows, options->markers);
  command.rows(std::move(rows));
  command.runs([options] { run_detect(*options); });
}

}  // namespace marey::cli
