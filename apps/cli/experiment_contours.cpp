#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"

#include "command_line.h"
#include "commands.h"
#include "experiments/contours.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct ExperimentContours {
  experiments::ContourExperimentOptions options;
  bool json = false;
  bool markdown = false;
  bool quiet = false;
};

Json as_json(const experiments::ContourExperiment& experiment) {
  Json list = Json::array();
  for (const experiments::ContourRow& row : experiment.rows) {
    Json entry = {{"figure", row.name}, {"must", row.must}, {"samples", row.samples}};
    for (std::size_t m = 0; m < row.values.size(); ++m) {
      if (row.values[m]) entry["methods"][experiments::kContourMethods[m]] = *row.values[m];
    }
    list.push_back(std::move(entry));
  }
  return {{"seed", experiment.seed}, {"videos", experiment.videos}, {"figures", list}};
}

void run(ExperimentContours& command) {
  const experiments::ContourExperiment experiment =
      with_progress(command.quiet, [&](const Hooks& hooks) { return experiments::run_contour_experiment(command.options, hooks); });
  if (experiment.rows.empty())
    throw Error("--only {}: no case of that name; see docs/reference/experiments.md", command.options.only);
  if (command.json) {
    print(as_json(experiment));
  } else if (command.markdown) {
    fmt::print("{}", experiments::to_markdown(experiment));
  } else if (!command.quiet) {
    fmt::print("{}", experiments::to_text(experiment));
  }
}

}  // namespace

void add_experiment_contours(Command& experiment) {
  auto options = std::make_shared<ExperimentContours>();
  Command command = experiment.subcommand(
      "contours",
      "Contours against true silhouettes: alone, behind a board, overlapping, after occlusions; next to a naive method");
  command.whole("--videos", options->options.videos, "N", 1, 10'000, "per case");
  command.seed(options->options.seed, "of the first video; the others follow");
  command.text("--only", options->options.only, "cases whose name contains this text");
  command.reports(options->json, options->quiet, "tables", &options->markdown);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
