#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "experiments/trackers.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct ExperimentTrackers {
  experiments::TrackerExperimentOptions options;
  std::string out;
  bool json = false;
  bool quiet = false;
};

nlohmann::json as_json(const std::vector<experiments::TrackerRow>& rows) {
  constexpr std::array<const char*, experiments::TrackerRow::kSituations> kNames{"slow", "rapid", "acceleration", "occlusion",
                                                                                 "swap"};
  nlohmann::json list = nlohmann::json::array();
  for (const experiments::TrackerRow& row : rows) {
    nlohmann::json entry = {{"method", row.method}};
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
  experiments::TrackerExperiment experiment;
  {
    ProgressBar bar(command.quiet);
    options.progress = [&](int done, int all) { bar.show("videos", done, all); };
    experiment = experiments::run_tracker_experiment(options);
  }
  if (command.json) {
    const nlohmann::json json = {{"videos", experiment.videos},
                                 {"seed", experiment.seed},
                                 {"paper", as_json(experiment.paper)},
                                 {"ours", as_json(experiment.ours)}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", experiments::to_text(experiment));
  }
  if (command.out.empty()) return;
  for (const std::string& name : experiments::draw_experiment(experiment, command.out)) {
    if (!command.quiet) fmt::print(stderr, "drawn: {}\n", name);
  }
}

}  // namespace

void add_experiment(CLI::App& app) {
  CLI::App* experiment = app.add_subcommand("experiment", "Repeat the experiments of the papers that Marey is built on");
  experiment->require_subcommand(1);
  auto options = std::make_shared<ExperimentTrackers>();
  CLI::App* trackers =
      experiment->add_subcommand("trackers", "Tables I-VII of the OpenMoCap paper: every filter, in five situations");
  trackers->add_option("--videos", options->options.videos, "in each situation")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  trackers->add_option("--seed", options->options.seed, "of the first video; the others follow")->capture_default_str();
  trackers->add_option("--out", options->out, "folder for a plot of each table and a picture like Figure 3, as SVG");
  trackers->add_flag("--json", options->json, "print JSON instead of tables");
  trackers->add_flag("-q,--quiet", options->quiet, "no progress");
  trackers->callback([options] { run(*options); });
  add_experiment_outlines(*experiment);
  add_experiment_hypotheses(*experiment);
}

}  // namespace marey::cli
