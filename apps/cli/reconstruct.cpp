#include "marey/pipeline/reconstruct.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/motion/marker_set.h"

#include "commands.h"
#include "progress_bar.h"
#include "rig_inputs.h"

namespace marey::cli {
namespace {

struct ReconstructCommand {
  RigInputs inputs;
  std::string out, labels;
  pipeline::ReconstructOptions options;
  bool json = false;
  bool quiet = false;
};

constexpr int kInterrupted = 130;  // the exit code of a program that Ctrl-C ended

std::atomic<bool> interrupted = false;

void interrupt(int) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

nlohmann::json as_json(const pipeline::ReconstructSummary& summary, const std::string& out) {
  nlohmann::json json = {{"frames", summary.frames},
                         {"seconds", summary.seconds},
                         {"rate_hz", summary.rate_hz},
                         {"markers", summary.markers},
                         {"labelled", summary.labelled},
                         {"observations", summary.observations},
                         {"unexplained", summary.unexplained},
                         {"points", {{"measured", summary.measured}, {"filled", summary.filled}, {"predicted", summary.predicted}}},
                         {"noise_px", summary.noise_px},
                         {"stopped", summary.stopped},
                         {"warnings", summary.warnings},
                         {"take", out}};
  json["residual_px"] = summary.residual_px ? nlohmann::json(*summary.residual_px) : nlohmann::json();
  for (const auto& camera : summary.cameras) json["cameras"][camera.name] = {{"frames", camera.frames}, {"missed", camera.missed}};
  for (const pipeline::StageReport& stage : summary.stages) {
    json["stages"][stage.name] = {{"count", stage.count}, {"median_ms", 1000 * stage.median}, {"p99_ms", 1000 * stage.p99}};
  }
  return json;
}

void print(const pipeline::ReconstructSummary& summary, const std::string& out) {
  fmt::print(stderr, "{} {} ({} with labels) in {} frames ({:.1f} s at {:g} Hz)\n", summary.markers,
             summary.markers == 1 ? "marker" : "markers", summary.labelled, summary.frames, summary.seconds, summary.rate_hz);
  fmt::print(stderr, "points: {} measured, {} filled, {} predicted; {} of {} blobs belong to no marker\n", summary.measured,
             summary.filled, summary.predicted, summary.unexplained, summary.observations);
  if (summary.residual_px) {
    fmt::print(stderr, "reprojection: {:.3f} px rms; noise of a blob {:.3f} px\n", *summary.residual_px, summary.noise_px);
  }
  for (const pipeline::StageReport& stage : summary.stages) {
    fmt::print(stderr, "  {:<14} median {:8.3f} ms, 99 % within {:8.3f} ms\n", stage.name, 1000 * stage.median, 1000 * stage.p99);
  }
  fmt::print(stderr, "take: {}\n", out);
}

void run(const ReconstructCommand& command) {
  pipeline::ReconstructOptions options = command.options;
  if (!command.labels.empty()) options.set = format::motion::read_marker_set(command.labels);
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  const auto summary = [&] {
    ProgressBar bar(command.quiet);
    pipeline::RunHooks hooks;
    hooks.stop = [] { return interrupted.load(); };
    hooks.progress = [&](const pipeline::TrackProgress& now) { bar.show("reconstructing", now.done, now.total); };
    return pipeline::reconstruct(rig_of(command.inputs), command.inputs.observations, command.out, options, hooks);
  }();
  for (const std::string& warning : summary.warnings) fmt::print(stderr, "marey: warning: {}\n", warning);
  if (command.json) {
    fmt::print("{}\n", as_json(summary, command.out).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!command.quiet) {
    print(summary, command.out);
  }
  if (summary.stopped) throw CLI::RuntimeError(kInterrupted);
}

}  // namespace

void add_reconstruct(CLI::App& app) {
  auto options = std::make_shared<ReconstructCommand>();
  CLI::App* command = app.add_subcommand("reconstruct", "Place and follow the markers that several calibrated cameras see");
  add_rig_inputs(*command, options->inputs);
  pipeline::ReconstructOptions& how = options->options;
  command->add_option("-o,--out", options->out, "what is written: a take, NAME.marey; or .c3d, .trc, .csv")->required();
  command->add_option("--labels", options->labels,
                      "the markers' names: CSV label,x,y,z as they lie at the beginning (m), or a name a line, by growing x");
  command->add_option("--rate", how.rate_hz, "frames a second, where sources and the rig do not tell")->check(CLI::PositiveNumber);
  command->add_option("--noise", how.noise_px, "standard deviation of a blob's place and of the calibration, px (default: learned)")
      ->check(CLI::Range(1e-3, 100.0));
  command->add_option("--fill", how.fill_s, "the longest gap that is filled, s")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--predict", how.predict_s, "tell so much of a longer gap as it was expected, s; at most --fill")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--marker-width", how.tracker.marker_width, "m; markers nearer than this disturb each other")
      ->check(CLI::Range(1e-4, 1.0))
      ->capture_default_str();
  command->add_option("--max-speed", how.tracker.max_speed, "no marker moves faster, m/s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--threshold", how.markers.threshold,
                      "grey level that a marker's pixels pass (default: from the picture's noise)");
  command
      ->add_option("--widest", how.markers.widest,
                   "px: markers are no wider and may lie on anything that is; else they lie on a plain ground")
      ->check(CLI::Range(2.0, 200.0));
  command->add_option("--min-area", how.markers.min_area, "smallest marker, in pixels above the threshold")->capture_default_str();
  command->add_option("--max-area", how.markers.max_area, "largest marker, likewise")->capture_default_str();
  command->add_option("--min-roundness", how.markers.min_roundness, "from 0, anything, to 1, a disc")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--dark", how.markers.dark, "markers are darker than what is around them");
  command->add_flag("--json", options->json, "print the summary as JSON on standard output");
  command->add_flag("-q,--quiet", options->quiet, "no progress and no summary; warnings stay");
  command->callback([options] { run(*options); });
}

}  // namespace marey::cli
