// CLEAR-MOT: K. Bernardin and R. Stiefelhagen, "Evaluating multiple object tracking performance", EURASIP JIVP 2008, in the
// reading of py-motmetrics 1.4, whose choices matter where the paper is silent:
//   - an object's last match is remembered through any gap, so that another track after it is a switch;
//   - two objects may remember the same track; the one that stands first in the truth file keeps it;
//   - the rest is matched for the most pairs first, then the least total distance;
//   - mostly tracked begins at 0.8 exactly.
#include "marey/evaluate/clear.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::evaluate {

void ClearCounter::add(const FramePairs& frame) {
  column_of_row_.assign(frame.objects().size(), assign::kNoIndex);
  column_matched_.assign(frame.tracks().size(), 0);
  if (frame.has_both()) {
    keep_last_matches(frame);
    match_the_rest(frame);
  }
  count_unmatched(frame);
}

void ClearCounter::keep_last_matches(const FramePairs& frame) {
  const auto tracks = frame.tracks();
  for (std::size_t column = 0; column < tracks.size(); ++column) column_of_track_[tracks[column]] = static_cast<int>(column);
  for (std::size_t row = 0; row < frame.objects().size(); ++row) {
    const int track = objects_[frame.objects()[row]].track;
    if (track == assign::kNoIndex) continue;
    const int column = column_of_track_[track];
    if (column == assign::kNoIndex || column_matched_[column]) continue;
    if (close_enough(frame.distances_of(row)[column])) match(frame, row, column);
  }
  for (const int track : tracks) column_of_track_[track] = assign::kNoIndex;
}

void ClearCounter::match_the_rest(const FramePairs& frame) {
  if (!fill_costs(frame)) return;
  const int rows = static_cast<int>(frame.objects().size());
  const int columns = static_cast<int>(frame.tracks().size());
  const auto assigned = assigner_.assign(rows, columns, costs_);
  for (int row = 0; row < rows; ++row) {
    const int column = assigned[row];
    if (column == assign::kNoIndex || column_of_row_[row] != assign::kNoIndex || column_matched_[column]) continue;
    if (close_enough(frame.distances_of(row)[column])) match(frame, row, column);
  }
}

/// Distances of the pairs that are left, and for every other pair a cost so high that it is chosen only where nothing else is:
/// the most pairs come before the least distance. False where no pair is left.
bool ClearCounter::fill_costs(const FramePairs& frame) {
  constexpr double forbidden = std::numeric_limits<double>::infinity();
  costs_.assign(frame.objects().size() * frame.tracks().size(), forbidden);
  const std::size_t columns = frame.tracks().size();
  double largest = -1;
  for (std::size_t row = 0; row < column_of_row_.size(); ++row) {
    if (column_of_row_[row] != assign::kNoIndex) continue;
    const auto distances = frame.distances_of(row);
    for (std::size_t column = 0; column < columns; ++column) {
      const double distance = distances[column];
      if (column_matched_[column] || !close_enough(distance)) continue;
      costs_[row * columns + column] = distance;
      largest = std::max(largest, std::abs(distance));
    }
  }
  if (largest < 0) return false;
  const double most_pairs = static_cast<double>(std::min(column_of_row_.size(), columns));
  std::replace(costs_.begin(), costs_.end(), forbidden, 2 * most_pairs * (largest + 1) + 1);
  return true;
}

void ClearCounter::match(const FramePairs& frame, std::size_t row, std::size_t column) {
  column_of_row_[row] = static_cast<int>(column);
  column_matched_[column] = 1;
  Object& object = objects_[frame.objects()[row]];
  const int track = frame.tracks()[column];
  if (object.track != assign::kNoIndex && object.track != track) {
    ++counts_.switches;
    ++object.switches;
  }
  if (object.lost) ++counts_.fragmentations;
  object.track = track;
  object.lost = false;
  ++object.found;
  ++counts_.matches;
  total_distance_ += frame.distances_of(row)[column];
}

void ClearCounter::count_unmatched(const FramePairs& frame) {
  for (std::size_t row = 0; row < column_of_row_.size(); ++row) {
    Object& object = objects_[frame.objects()[row]];
    ++object.frames;
    if (column_of_row_[row] != assign::kNoIndex) continue;
    object.lost = object.found > 0;
    ++counts_.misses;
  }
  counts_.false_positives += std::count(column_matched_.begin(), column_matched_.end(), 0);
}

ClearScores ClearCounter::scores() const {
  ClearScores scores = counts_;
  for (const Object& object : objects_) {
    const double fraction = static_cast<double>(object.found) / static_cast<double>(object.frames);
    ++(fraction >= 0.8 ? scores.mostly_tracked : fraction >= 0.2 ? scores.partially_tracked : scores.mostly_lost);
  }
  const auto true_boxes = static_cast<double>(scores.matches + scores.misses);
  const auto track_boxes = static_cast<double>(scores.matches + scores.false_positives);
  const auto matches = static_cast<double>(scores.matches);
  if (true_boxes > 0) {
    scores.mota = 1 - static_cast<double>(scores.misses + scores.switches + scores.false_positives) / true_boxes;
    scores.recall = matches / true_boxes;
  }
  if (track_boxes > 0) scores.precision = matches / track_boxes;
  if (matches > 0) scores.motp = total_distance_ / matches;
  return scores;
}

}  // namespace marey::evaluate
