#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"

namespace marey::experiments {

/// Mean prediction error with its 99 % confidence interval, px.
struct PredictionError {
  std::int64_t samples = 0;
  double low = 0, mean = 0, high = 0;
};

/// Of the times of single steps, ms.
struct StepTime {
  int markers = 0;
  double percentile_5 = 0, median = 0, percentile_95 = 0, maximum = 0;
};

/// One row of the tables: a tracking method, and the result. What is not known is missing.
struct TrackerRow {
  static constexpr std::size_t kSituations = 5;  ///< slow, rapid, acceleration, occlusion, crossing
  static constexpr std::size_t kMotions = 3;     ///< the first three, in which the paper measures errors

  std::string method;
  std::array<std::optional<int>, kSituations> losses;
  std::array<std::optional<PredictionError>, kMotions> errors;
  std::vector<StepTime> times;
};

struct TrackerExperiment {
  int videos = 20;  ///< in each situation
  std::uint64_t seed = 0;
  std::vector<TrackerRow> paper;  ///< what the paper printed
  std::vector<TrackerRow> ours;   ///< measured rows: the paper's three methods first, Marey's default last
};

struct TrackerExperimentOptions {
  int videos = 20;
  std::uint64_t seed = 1;
  std::vector<int> timed_markers = {1, 5, 10, 15, 20, 25, 30};
};

/// Tables I–VII of Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion
/// Capture System". Every video is rendered, encoded, decoded and seen through the marker detector, once; every method then tracks
/// the detections, with the past alone. Losses follow evaluate_labels; an error is the distance from the prediction made before
/// a frame to the point then measured, in videos without a loss. Throws Error if videos cannot be written to the temporary
/// folder.
TrackerExperiment run_tracker_experiment(const TrackerExperimentOptions& options, const Hooks& hooks = {});

/// Tables I–VII as text, the paper's rows above ours.
std::string to_text(const TrackerExperiment& experiment);

/// One table in Markdown: losses and mean prediction errors.
std::string to_markdown(const TrackerExperiment& experiment);

/// Writes a plot of each table and an image like the paper's Figure 3 into `folder`, as SVG. Returns their names.
/// Throws Error if it cannot.
std::vector<std::string> draw_experiment(const TrackerExperiment& experiment, const std::string& folder);

}  // namespace marey::experiments
