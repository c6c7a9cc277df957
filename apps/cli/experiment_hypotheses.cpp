#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "experiments/hypotheses.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct ExperimentHypotheses {
  experiments::HypothesesExperimentOptions options;
  bool json = false;
  bool quiet = false;
};

nlohmann::json as_json(const experiments::HypothesesExperiment& experiment) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t kind = 0; kind < experiment.kinds.size(); ++kind) {
    nlohmann::json entry = {{"meeting", experiment.kinds[kind]}, {"meetings", experiment.meetings[kind]}};
    for (const auto& row : experiment.rows) {
      const auto& score = row.scores[kind];
      entry["methods"][row.method] = {{"switches", score.switches},
                                      {"people", score.people},
                                      {"misses", score.misses},
                                      {"false", score.strangers},
                                      {"step_us", score.step_us}};
    }
    list.push_back(std::move(entry));
  }
  return {{"scenes", experiment.scenes}, {"seed", experiment.seed}, {"kinds", list}};
}

void run(const ExperimentHypotheses& command) {
  experiments::HypothesesExperimentOptions options = command.options;
  experiments::HypothesesExperiment experiment;
  {
    ProgressBar bar(command.quiet);
    options.progress = [&](int done, int all) { bar.show("scenes", done, all); };
    experiment = experiments::run_hypotheses_experiment(options);
  }
  fmt::print("{}", command.json ? as_json(experiment).dump(2) + "\n" : experiments::to_text(experiment));
}

}  // namespace

void add_experiment_hypotheses(CLI::App& experiment) {
  auto options = std::make_shared<ExperimentHypotheses>();
  CLI::App* hypotheses = experiment.add_subcommand(
      "hypotheses", "People who cross, run side by side and stop together: who keeps them apart, nearest neighbour or hypotheses");
  simulate::EncounterOptions& encounters = options->options.encounters;
  track::ground::GroundTrackerOptions& tracker = options->options.tracker;
  hypotheses->add_option("--scenes", options->options.scenes, "of each kind of meeting")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  hypotheses->add_option("--seed", options->options.seed, "of the first scene; the others follow")->capture_default_str();
  hypotheses->add_option("--missed", encounters.missed, "probability that somebody is not seen in a frame")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  hypotheses->add_option("--clutter", encounters.clutter, "false observations a frame")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  hypotheses->add_option("--merged", encounters.merged, "m; two nearer than this are seen as one")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  hypotheses->add_option("--hypotheses", tracker.hypotheses, "kept for each cluster, at most")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  hypotheses->add_option("--window", tracker.window, "s; what is older is decided")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  hypotheses->add_flag("--json", options->json, "print JSON instead of tables");
  hypotheses->add_flag("-q,--quiet", options->quiet, "no progress");
  hypotheses->callback([options] { run(*options); });
}

}  // namespace marey::cli
