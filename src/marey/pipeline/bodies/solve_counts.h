#pragma once

#include <cstdint>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::pipeline::bodies {

/// Sums up poses as they come.
class SolveCounts {
 public:
  /// `skeleton` outlives this.
  explicit SolveCounts(const Skeleton& skeleton);

  void add(const solve::skeleton::SolvedPose& pose);
  /// All but the number of initialisations is forgotten.
  void restart();
  void write(const SkeletonMotion& motion, SolveSummary& summary);

 private:
  SolveSummary::Coordinate coordinate(std::size_t c, const SkeletonMotion& motion);

  const Skeleton* skeleton_;
  std::vector<SolveSummary::Marker> markers_;
  std::vector<std::vector<float>> deviations_;
  std::vector<std::int64_t> observed_;
  std::int64_t starts_ = 0, empty_ = 0;
};

}  // namespace marey::pipeline::bodies
