#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "command_line.h"
#include "commands.h"
#include "experiments/marker_names.h"
#include "json_value.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct ExperimentMarkers {
  experiments::MarkerNamesOptions options;
  bool json = false;
  bool markdown = false;
  bool quiet = false;
};

Json as_json(const std::vector<experiments::MarkerNamesRow>& rows) {
  Json list = Json::array();
  for (const experiments::MarkerNamesRow& row : rows) {
    list.push_back({{"scene", row.scene},
                    {"videos", row.videos},
                    {"lost", row.lost},
                    {"lost_exact", row.lost_exact},
                    {"peer_lost", row.peer_lost},
                    {"peer_lost_exact", row.peer_lost_exact}});
  }
  return list;
}

void run(const ExperimentMarkers& command) {
  experiments::MarkerNamesOptions options = command.options;
  std::vector<experiments::MarkerNamesRow> rows;
  {
    ProgressBar bar(command.quiet);
    options.progress = [&](int done, int all) { bar.show("videos", done, all); };
    rows = experiments::run_marker_names(options);
  }
  if (command.json) {
    print({{"seed", options.seed}, {"names", as_json(rows)}});
  } else if (command.markdown) {
    fmt::print("{}", experiments::to_markdown(rows));
  } else if (!command.quiet) {
    fmt::print("{}", experiments::to_text(rows));
  }
}

}  // namespace

void add_experiment_markers(Command& experiment) {
  auto options = std::make_shared<ExperimentMarkers>();
  Command command = experiment.subcommand(
      "markers", "Markers where they are hard to find and to distinguish, beside what a plain threshold does");
  command.whole("--videos", options->options.videos, "N", 1, 10'000, "of each scene");
  command.seed(options->options.seed, "of the first video; the others follow");
  command.text("--only", options->options.only, "scenes whose names contain this");
  command.reports(options->json, options->quiet, "tables", &options->markdown);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
