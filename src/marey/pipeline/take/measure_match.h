#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/measure.h"
#include "marey/core/hooks.h"

namespace marey::pipeline::take {

struct MeasureMatchOptions {
  analyse::MeasureOptions how;
  std::string metadata;             ///< of formats that keep it in a file of its own; empty: it is found under a like name
  double rate_hz = 25;              ///< where the tracks do not specify
  std::optional<bool> y_down = {};  ///< of the page; nothing: as the tracks have it
};

/// Where the results go; what is empty is not made.
struct MeasureOutput {
  std::string figures;  ///< CSV: id,label,team,distance_m,mean_mps,top_mps,sprints, then the rest; a row for each person
  std::string report;   ///< a folder, which is made, for report.html: one page with plots, tables, heat maps and paths
};

struct MatchMeasurement {
  analyse::Measurement measured;
  std::vector<std::string> warnings;  ///< one sentence each: what is doubtful in the page
};

/// How far and how fast every person of `tracks` ran, a file of places on the ground that format/match reads. Throws Error if it
/// cannot be read, no person is in it for long enough, or an output cannot be written; Stopped.
MatchMeasurement measure_match(const std::string& tracks, const MeasureOutput& output, const MeasureMatchOptions& options,
                               const Hooks& hooks = {});

}  // namespace marey::pipeline::take
