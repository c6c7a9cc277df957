#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/evaluate/ground_evaluation.h"

namespace marey::pipeline::take {

/// How far a person went by the truth and by the track that is theirs, over the instants that both have. Paths are smoothed alike.
struct PathLengths {
  int id = 0;
  double true_m = 0, track_m = 0;
};

/// Tracks on the ground, or in space, against the truth.
struct MatchEvaluation {
  evaluate::GroundEvaluation evaluation;
  std::vector<PathLengths> path_lengths;  ///< of people with a track; none where the instants are too far apart to add up paths
  std::optional<double> distance_error;   ///< differences of the lengths by amount, over the true lengths: a share
  bool by_time = false;                   ///< instants were paired by time, not by frame number
  bool has_speed = false;                 ///< whether the speeds of both sides are known
  std::vector<std::string> warnings;      ///< one sentence each
};

/// Pairs the instants of both and evaluates the tracks. Instants go together by frame number where frames mean the same time in
/// both, else by time, the nearest within half a period; where one file has instants more often, the other's instants alone are
/// evaluated. A side of people without velocities gets them from its smoothed paths. Throws Error if a recording is not in m, or
/// one is of the ground and the other of space.
MatchEvaluation evaluate_match(const Recording& truth, const Recording& tracks, double farthest);

}  // namespace marey::pipeline::take
