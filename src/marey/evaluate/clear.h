#pragma once

#include <span>
#include <vector>

#include "marey/assign/linear_assignment.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/frame_walk.h"

namespace marey::evaluate {

/// Counts CLEAR-MOT events frame by frame.
class ClearCounter {
 public:
  /// What lies farther than `most_distance` is not a match.
  ClearCounter(int objects, int tracks, double most_distance)
      : max_distance_(most_distance), objects_(objects), column_of_track_(tracks, assign::kNoIndex) {}

  void add(const FramePairs& frame);
  ClearScores scores() const;

  /// What happened to one object.
  struct Object {
    int track = assign::kNoIndex;  ///< its last match
    std::int64_t frames = 0;
    std::int64_t found = 0;
    std::int64_t switches = 0;
    bool lost = false;  ///< found before, and missed since
  };
  const std::vector<Object>& objects() const { return objects_; }
  /// Of the frame added last: each row's column, or assign::kNoIndex.
  std::span<const int> column_of_row() const { return column_of_row_; }

 private:
  bool close_enough(double distance) const { return !(distance > max_distance_); }
  void keep_last_matches(const FramePairs& frame);
  void match_the_rest(const FramePairs& frame);
  bool fill_costs(const FramePairs& frame);
  void match(const FramePairs& frame, std::size_t row, std::size_t column);
  void count_unmatched(const FramePairs& frame);

  double max_distance_;
  std::vector<Object> objects_;
  std::vector<int> column_of_track_;  // in the frame at hand
  std::vector<int> column_of_row_;
  std::vector<char> column_matched_;
  std::vector<double> costs_;
  assign::LinearAssigner assigner_;
  ClearScores counts_;
  double total_distance_ = 0;
};

}  // namespace marey::evaluate
