#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/simulate/people/people_video.h"
#include "marey/track/contour/contour_tracker.h"

#include "experiments/contour_evaluator.h"

namespace marey::experiments {

/// The methods compared: the naive peer (naive_contours.h), the silhouettes of Marey's detector, Marey's contours.
inline constexpr std::array<const char*, 3> kContourMethods{"naive", "silhouettes", "Marey"};

/// Videos of one kind.
struct ContourCase {
  std::string name;
  simulate::people::PeopleSituation situation{};
  double height_px = 60;
  bool degraded = false;                    ///< halo, blur, colour fringe and blocks, as a broadcast camera gives it
  bool same_shirts = false;                 ///< both people of one team
  std::optional<int> crf = {};              ///< encoded by x264 and decoded
  std::optional<double> hidden_s = {};      ///< longest full occlusion behind a board
  std::optional<double> min_hidden_s = {};  ///< the shortest; a fifth of the longest without
  bool in_pairs = false;                    ///< two people at each board, hidden at once
  std::optional<int> frames = {};           ///< of each video; the default of the situation without
  std::optional<int> people = {};           ///< the default of the situation without
  cv::Size size{768, 576};                  ///< px
  bool timed = false;                       ///< for the speed alone; its shapes are not counted
  int videos = 1;
};

/// One row of the table: a figure of one or more cases, for each method.
struct ContourRow {
  std::string name;
  std::string must;  ///< what the figure is meant to be
  std::array<std::optional<double>, kContourMethods.size()> values;
  std::int64_t samples = 0;  ///< of Marey's figure
  int digits = 2;
  bool is_time = false;  ///< of this machine, and of what else it does: not in Markdown
};

struct ContourExperiment {
  std::uint64_t seed = 0;
  int videos = 0;
  std::vector<ContourRow> rows;
};

struct ContourExperimentOptions {
  int videos = 4;  ///< of each case
  std::uint64_t seed = 1;
  std::string only;  ///< cases whose name contains this text; empty for all
  track::contour::OutlineOptions outlines;
};

/// Contours against true silhouettes in simulated videos: people alone, behind a board, two who overlap, full occlusions. All
/// methods run with the past alone and settings that are the same for all cases; the detector is primed with earlier images of the
/// scene.
ContourExperiment run_contour_experiment(const ContourExperimentOptions& options, const Hooks& hooks = {});

std::string to_text(const ContourExperiment& experiment);
std::string to_markdown(const ContourExperiment& experiment);

}  // namespace marey::experiments
