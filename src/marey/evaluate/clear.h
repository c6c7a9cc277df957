#pragma once

#include <vector>

#include "marey/assign/linear_assignment.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/frame_walk.h"

namespace marey {

/// Counts CLEAR-MOT events frame by frame.
class ClearCounter {
 public:
  ClearCounter(int objects, int tracks, double least_overlap)
      : most_distance_(1 - least_overlap), objects_(objects), column_of_track_(tracks, LinearAssigner::nobody) {}

  void add(const FrameWalk& frame);
  ClearScores scores() const;

 private:
  struct Object {
    int track = LinearAssigner::nobody;  ///< its last match
    std::int64_t frames = 0;
    std::int64_t found = 0;
    bool lost = false;  ///< found before, and missed since
  };
  bool close_enough(double distance) const { return !(distance > most_distance_); }
  void keep_last_matches(const FrameWalk& frame);
  void match_the_rest(const FrameWalk& frame);
  bool fill_costs(const FrameWalk& frame);
  void match(const FrameWalk& frame, std::size_t row, std::size_t column);
  void count_unmatched(const FrameWalk& frame);

  double most_distance_;
  std::vector<Object> objects_;
  std::vector<int> column_of_track_;  // in the frame at hand
  std::vector<char> row_matched_, column_matched_;
  std::vector<double> costs_;
  LinearAssigner assigner_;
  ClearScores counts_;
  double total_distance_ = 0;
};

}  // namespace marey
