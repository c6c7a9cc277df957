#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"

#include "commands.h"
#include "experiments/outlines.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct ExperimentOutlines {
  experiments::OutlineExperimentOptions options;
  bool json = false;
  bool quiet = false;
};

nlohmann::json as_json(const experiments::OutlineExperiment& experiment) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t c = 0; c < experiment.cases.size(); ++c) {
    const experiments::OutlineCase& what = experiment.cases[c];
    nlohmann::json entry = {{"case", what.name}, {"height_px", what.height_px}, {"films", what.videos}, {"people", what.people}};
    if (what.true_jitter) entry["true_jitter_px"] = *what.true_jitter;
    for (const auto& row : experiment.rows) {
      const experiments::OutlineScore& score = row.scores[c];
      nlohmann::json& method = entry["methods"][row.method];
      method = {{"iou", score.iou}, {"lost", score.lost}, {"followed", score.followed}, {"frames", score.frames}};
      if (score.centre_error) method["centre_error_px"] = *score.centre_error;
      if (score.jitter) method["jitter_px"] = *score.jitter;
      if (score.target_us) method["target_us"] = *score.target_us;
    }
    list.push_back(std::move(entry));
  }
  return {{"seed", experiment.seed}, {"cases", list}};
}

void run(const ExperimentOutlines& command) {
  experiments::OutlineExperimentOptions options = command.options;
  experiments::OutlineExperiment experiment;
  {
    ProgressBar bar(command.quiet);
    options.progress = [&](int done, int all) { bar.show("films", done, all); };
    experiment = experiments::run_outline_experiment(options);
  }
  if (experiment.cases.empty()) throw Error("no case's name holds \"{}\"", options.only);
  fmt::print("{}", command.json ? as_json(experiment).dump(2) + "\n" : experiments::to_text(experiment));
}

}  // namespace

void add_experiment_outlines(CLI::App& experiment) {
  auto options = std::make_shared<ExperimentOutlines>();
  CLI::App* outlines = experiment.add_subcommand(
      "outlines", "Coupled Kalman filters on B-splines as published, a box filter, and Marey's outlines, on simulated people");
  outlines->add_option("--videos", options->options.videos, "of two people who meet or are hidden; of other cases a tenth")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  outlines->add_option("--seed", options->options.seed, "of the first video; the others follow")->capture_default_str();
  outlines->add_option("--only", options->options.only, "cases whose name holds this text");
  outlines->add_flag("--json", options->json, "print JSON instead of tables");
  outlines->add_flag("-q,--quiet", options->quiet, "no progress");
  outlines->callback([options] { run(*options); });
}

}  // namespace marey::cli
