#pragma once

#include <array>
#include <vector>

#include "marey/assign/linear_assignment.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/frame_walk.h"
#include "marey/evaluate/pair_table.h"

namespace marey::evaluate {

/// HOTA's counts at one overlap. Those of several recordings are added, as trackeval combines sequences.
struct HotaLevel {
  double matches = 0;
  double association = 0;         ///< sum over the matches of their pair's AssA
  double association_recall = 0;  ///< likewise
  double association_precision = 0;
  double overlap = 0;  ///< sum over the matches
};

/// Everything that HOTA is made of.
struct HotaCounts {
  std::array<HotaLevel, hota_levels> levels{};
  double true_boxes = 0, track_boxes = 0;

  HotaCounts& operator+=(const HotaCounts& other);
  HotaScores scores() const;
};

/// Counts HOTA in two passes: `see` every frame, `align` once, `match` every frame.
class HotaCounter {
 public:
  /// `pairs` is shared with the one who else counts by pairs of ids, and outlives this.
  HotaCounter(int objects, int tracks, PairTable& pairs) : pairs_(pairs), object_frames_(objects), track_frames_(tracks) {}

  void observe_frame(const FramePairs& frame);
  void align();
  void match(const FramePairs& frame);
  HotaCounts counts() const;

 private:
  PairTable& pairs_;
  std::vector<double> object_frames_, track_frames_;  // in how many frames each is
  std::vector<double> row_sums_, column_sums_, costs_;
  assign::LinearAssigner assigner_;
  std::array<double, hota_levels + 1> overlap_at_level_{};
};

}  // namespace marey::evaluate
