#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "command_line.h"
#include "commands.h"
#include "experiments/hypotheses.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct ExperimentHypotheses {
  experiments::HypothesesExperimentOptions options;
  bool json = false;
  bool markdown = false;
  bool quiet = false;
};

Json as_json(const experiments::HypothesesExperiment& experiment) {
  Json list = Json::array();
  for (std::size_t kind = 0; kind < experiment.kinds.size(); ++kind) {
    Json entry = {{"meeting", experiment.kinds[kind]}, {"meetings", experiment.close_encounters[kind]}};
    for (const auto& row : experiment.rows) {
      const auto& score = row.scores[kind];
      entry["methods"][row.method] = {{"switches", score.switches},
                                      {"people", score.people},
                                      {"misses", score.misses},
                                      {"false", score.untrusted},
                                      {"step_us", score.step_us}};
    }
    list.push_back(std::move(entry));
  }
  return {{"scenes", experiment.scenes}, {"seed", experiment.seed}, {"kinds", list}};
}

void run(const ExperimentHypotheses& command) {
  const experiments::HypothesesExperiment experiment = with_progress(
      command.quiet, [&](const Hooks& hooks) { return experiments::run_hypotheses_experiment(command.options, hooks); });
  if (command.json) {
    print(as_json(experiment));
  } else if (command.markdown) {
    fmt::print("{}", experiments::to_markdown(experiment));
  } else if (!command.quiet) {
    fmt::print("{}", experiments::to_text(experiment));
  }
}

}  // namespace

void add_experiment_hypotheses(Command& experiment) {
  auto options = std::make_shared<ExperimentHypotheses>();
  Command command = experiment.subcommand(
      "hypotheses", "People who cross, run side by side and stop together: who keeps them apart, nearest neighbour or hypotheses");
  simulate::EncounterOptions& encounters = options->options.encounters;
  track::ground::GroundTrackerOptions& tracker = options->options.tracker;
  command.whole("--scenes", options->options.scenes, "N", 1, 10'000, "of each kind of meeting");
  command.seed(options->options.seed, "of the first scene; the others follow");
  command.number("--miss-rate", encounters.missed, "probability", closed(0, 0.9), "that a person is not seen in a frame");
  command.number("--clutter", encounters.clutter, "per frame", closed(0, 100), "false observations");
  command.number("--merged", encounters.merged, "m", closed(0, 5), "two nearer than this are seen as one");
  command.whole("--hypotheses", tracker.hypotheses, "N", 1, 10'000, "kept for each cluster, at most");
  command.number("--window", tracker.window, "s", closed(0, 60), "what is older is decided");
  command.reports(options->json, options->quiet, "tables", &options->markdown);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
