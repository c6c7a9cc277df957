#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "marey/analyse/possession.h"
#include "marey/analyse/smooth_path.h"
#include "marey/core/geometry.h"
#include "marey/core/recording.h"
#include "marey/geometry/pitch.h"

namespace marey::analyse {

struct MeasureOptions {
  PathOptions path;
  /// Borders between speed zones, m/s, growing: standing and walking, jogging, running, high-speed running, sprinting.
  std::vector<double> zones = {2, 4, 5.5, 7};
  double sprint_mps = 7, sprint_s = 1;       ///< a sprint is at least so fast for at least this long
  double effort_mps2 = 2.5, effort_s = 0.5;  ///< the same of accelerations and decelerations
  geometry::PitchSize pitch;                 ///< for heat maps
  double cell_m = 2;                         ///< of heat maps
};

/// Seconds spent in each cell of the pitch, by rows along x.
struct HeatMap {
  int columns = 0, rows = 0;
  double cell_m = 2;
  std::vector<double> seconds;

  double& at(int column, int row) { return seconds[static_cast<std::size_t>(row) * columns + column]; }
};

struct PersonMeasure {
  int id = 0;
  std::string label, team;
  double seconds = 0;     ///< on some path
  double observed_s = 0;  ///< of them, those in which measured places give the speed: all below that is of speed is of these alone
  double distance_m = 0;
  double mean_mps = 0;
  std::optional<double> top_mps,
      top_sigma_mps;  ///< the fastest of which that is sure, and its standard deviation; absent if there is none, or if the mean
                      ///< is faster
  int sprints = 0;
  std::vector<std::pair<double, double>> sprint_times;  ///< s: when each began and ended
  int accelerations = 0, decelerations = 0;
  std::vector<double> zone_s, zone_m;  ///< one more than borders
  Vector<2> average_position = Vector<2>::Zero();
  HeatMap heat;
  std::vector<Path> paths;
  std::vector<ImpossibleSegment> impossible;  ///< what no person can have done; none of it counts
};

/// How a team stood, averaged over the instants at which at least three of its people are known.
struct TeamMeasure {
  std::string team;
  int people = 0;
  double distance_m = 0;
  double length_m = 0, width_m = 0;  ///< extent along x and y
  double hull_m2 = 0;                ///< area of the convex hull
  Vector<2> average_position = Vector<2>::Zero();
  int instants = 0;
};

struct Measurement {
  std::vector<PersonMeasure> people;  ///< by id; those without two places, or without a measurement, are omitted
  std::vector<TeamMeasure> teams;     ///< by name; people without a team are in none
  std::optional<BallMeasure> ball;    ///< where the recording has one, which is not one of the people
};

/// Distances, speeds, efforts and places of every person, from `paths_of`: smoothed by the options, or as recorded where the
/// recording is smoothed already, so that a run has one speed. Throws Error for a recording that is not of the ground in m. Cost:
/// linear in the samples.
Measurement measure(const Recording& recording, const MeasureOptions& options = {});

}  // namespace marey::analyse
