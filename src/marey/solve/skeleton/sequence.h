// A whole recording of a skeleton's markers: frame by frame as it is done while cameras see, or all frames together.
#pragma once

#include <span>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {

struct SequenceOptions {
  PoseOptions pose;
  bool whole = false;   ///< the recording as a whole decides the direction in which limbs are bent
  bool smooth = false;  ///< and a second pass over all frames at once
};

struct SolvedSequence {
  std::vector<std::vector<double>> rows;    ///< coordinates, one row a frame
  std::vector<std::vector<bool>> observed;  ///< of each coordinate
  std::vector<double> rms_m;                ///< of each frame's markers
};

/// Frames at an even rate.
SolvedSequence solve_sequence(const Skeleton& skeleton, std::span<const ObservedMarkers> frames, double rate_hz,
                              const SequenceOptions& options = {});

}  // namespace marey::solve::skeleton
