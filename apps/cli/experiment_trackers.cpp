#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "command_line.h"
#include "commands.h"
#include "experiments/trackers.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct ExperimentTrackers {
  experiments::TrackerExperimentOptions options;
  std::string out;
  bool json = false;
  bool markdown = false;
  bool quiet = false;
};

Json as_json(const std::vector<experiments::TrackerRow>& rows) {
  constexpr std::array<const char*, experiments::TrackerRow::kSituations> kNames{"slow", "rapid", "acceleration", "occlusion",
                                                                                 "swap"};
  Json list = Json::array();
  for (const experiments::TrackerRow& row : rows) {
    Json entry = {{"method", row.method}};
    for (std::size_t s = 0; s < row.losses.size(); ++s) {
      if (row.losses[s]) entry["losses"][kNames[s]] = *row.losses[s];
    }
    for (std::size_t s = 0; s < row.errors.size(); ++s) {
      if (!row.errors[s]) continue;
      entry["errors_px"][kNames[s]] = {{"samples", row.errors[s]->samples},
                                       {"low", row.errors[s]->low},
                                       {"mean", row.errors[s]->mean},
                                       {"high", row.errors[s]->high}};
    }
    for (const experiments::StepTime& time : row.times) {
      entry["times_ms"].push_back({{"markers", time.markers},
                                   {"p5", time.percentile_5},
                                   {"median", time.median},
                                   {"p95", time.percentile_95},
                                   {"max", time.maximum}});
    }
    list.push_back(std::move(entry));
  }
  return list;
}

void run(const ExperimentTrackers& command) {
  experiments::TrackerExperimentOptions options = command.options;
  if (command.markdown && command.out.empty()) options.timed_markers.clear();  // that table has no times
  const experiments::TrackerExperiment experiment =
      with_progress(command.quiet, [&](const Hooks& hooks) { return experiments::run_tracker_experiment(options, hooks); });
  if (command.json) {
    print({{"videos", experiment.videos},
           {"seed", experiment.seed},
           {"paper", as_json(experiment.paper)},
           {"ours", as_json(experiment.ours)}});
  } else if (command.markdown) {
    fmt::print("{}", experiments::to_markdown(experiment));
  } else if (!command.quiet) {
    fmt::print("{}", experiments::to_text(experiment));
  }
  if (command.out.empty()) return;
  for (const std::string& name : experiments::draw_experiment(experiment, command.out)) {
    if (!command.quiet) fmt::print(stderr, "drawn: {}\n", name);
  }
}

}  // namespace

void add_experiment_trackers(Command& experiment) {
  auto options = std::make_shared<ExperimentTrackers>();
  Command command = experiment.subcommand("trackers", "Tables I-VII of the OpenMoCap paper: every filter, in five situations");
  command.whole("--videos", options->options.videos, "N", 1, 10'000, "in each situation");
  command.seed(options->options.seed, "of the first video; the others follow");
  command.output_folder("-o,--output", options->out, "folder for a plot of each table and an image like Figure 3, as SVG");
  command.reports(options->json, options->quiet, "tables", &options->markdown);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
