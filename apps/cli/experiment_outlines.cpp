#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"

#include "command_line.h"
#include "commands.h"
#include "experiments/outlines.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct ExperimentOutlines {
  experiments::OutlineExperimentOptions options;
  bool json = false;
  bool markdown = false;
  bool quiet = false;
};

Json as_json(const experiments::OutlineExperiment& experiment) {
  Json list = Json::array();
  for (std::size_t c = 0; c < experiment.cases.size(); ++c) {
    const experiments::OutlineCase& what = experiment.cases[c];
    Json entry = {{"case", what.name}, {"height_px", what.height_px}, {"films", what.videos}, {"people", what.people}};
    if (what.true_jitter) entry["true_jitter_px"] = *what.true_jitter;
    for (const auto& row : experiment.rows) {
      const experiments::OutlineScore& score = row.scores[c];
      Json& method = entry["methods"][row.method];
      method = {{"iou", score.iou}, {"lost", score.lost}, {"followed", score.tracked}, {"frames", score.frames}};
      if (score.centre_error) method["centre_error_px"] = *score.centre_error;
      if (score.jitter) method["jitter_px"] = *score.jitter;
      if (score.target_us) method["target_us"] = *score.target_us;
    }
    list.push_back(std::move(entry));
  }
  return {{"seed", experiment.seed}, {"cases", list}};
}

void run(const ExperimentOutlines& command) {
  const experiments::OutlineExperiment experiment =
      with_progress(command.quiet, [&](const Hooks& hooks) { return experiments::run_outline_experiment(command.options, hooks); });
  if (experiment.cases.empty()) throw Error("no case's name holds \"{}\"", command.options.only);
  if (command.json) {
    print(as_json(experiment));
  } else if (command.markdown) {
    fmt::print("{}", experiments::to_markdown(experiment));
  } else if (!command.quiet) {
    fmt::print("{}", experiments::to_text(experiment));
  }
}

}  // namespace

void add_experiment_outlines(Command& experiment) {
  auto options = std::make_shared<ExperimentOutlines>();
  Command command = experiment.subcommand(
      "outlines", "Coupled Kalman filters on B-splines as published, a box filter, and Marey's outlines, on simulated people");
  command.whole("--videos", options->options.videos, "N", 1, 10'000,
                "of two people who meet or are hidden; of other cases a tenth");
  command.seed(options->options.seed, "of the first video; the others follow");
  command.text("--only", options->options.only, "cases whose name holds this text");
  command.reports(options->json, options->quiet, "tables", &options->markdown);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
