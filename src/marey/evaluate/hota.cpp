// HOTA: J. Luiten et al., "HOTA: a higher order metric for evaluating multi-object tracking", IJCV 129 (2021), as trackeval
// computes it. First every object and track that overlap are given a score of how well they go together over the whole
// recording; then each frame is matched for the largest sum of score × overlap, once for all 19 levels of overlap; at each level
// the matches that reach it are counted, DetA over boxes and AssA over the pairs of ids they belong to.
#include "marey/evaluate/hota.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace marey::evaluate {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// How many of the levels this overlap reaches.
int levels_reached(double overlap) {
  int level = 0;
  while (level < hota_levels && overlap >= 0.05 + level * 0.05 - epsilon) ++level;
  return level;
}

}  // namespace

void HotaCounter::observe_frame(const FramePairs& frame) {
  for (const int object : frame.objects()) ++object_frames_[object];
  for (const int track : frame.tracks()) ++track_frames_[track];
  row_sums_.assign(frame.objects().size(), 0);
  column_sums_.assign(frame.tracks().size(), 0);
  for (std::size_t row = 0; row < row_sums_.size(); ++row) {
    const auto overlaps = frame.similarities_of(row);
    for (std::size_t column = 0; column < overlaps.size(); ++column) {
      row_sums_[row] += overlaps[column];
      column_sums_[column] += overlaps[column];
    }
  }
  for (std::size_t row = 0; row < row_sums_.size(); ++row) {
    if (row_sums_[row] <= 0) continue;
    const auto overlaps = frame.similarities_of(row);
    for (std::size_t column = 0; column < overlaps.size(); ++column) {
      const double all = row_sums_[row] + column_sums_[column] - overlaps[column];
      if (overlaps[column] <= 0 || all <= epsilon) continue;
      pairs_.at(frame.objects()[row], frame.tracks()[column]).likeness += overlaps[column] / all;
    }
  }
}

void HotaCounter::align() {
  for (IdPair& pair : pairs_.pairs()) {
    pair.alignment = pair.likeness / (object_frames_[pair.object] + track_frames_[pair.track] - pair.likeness);
  }
}

void HotaCounter::match(const FramePairs& frame) {
  costs_.assign(frame.objects().size() * frame.tracks().size(), 0);
  const std::size_t columns = frame.tracks().size();
  bool any = false;
  for (std::size_t row = 0; row < frame.objects().size(); ++row) {
    const auto overlaps = frame.similarities_of(row);
    for (std::size_t column = 0; column < columns; ++column) {
      if (overlaps[column] <= 0) continue;
      costs_[row * columns + column] = -pairs_.at(frame.objects()[row], frame.tracks()[column]).alignment * overlaps[column];
      any = true;
    }
  }
  if (!any) return;
  const auto column_of_row = assigner_.assign(static_cast<int>(frame.objects().size()), static_cast<int>(columns), costs_);
  for (std::size_t row = 0; row < column_of_row.size(); ++row) {
    if (column_of_row[row] == assign::kNoIndex) continue;
    const double overlap = frame.similarities_of(row)[column_of_row[row]];
    const int level = levels_reached(overlap);
    if (level == 0) continue;
    ++pairs_.at(frame.objects()[row], frame.tracks()[column_of_row[row]]).at_level[level];
    overlap_at_level_[level] += overlap;
  }
}

HotaCounts HotaCounter::counts() const {
  HotaCounts counts;
  counts.true_boxes = std::accumulate(object_frames_.begin(), object_frames_.end(), 0.0);
  counts.track_boxes = std::accumulate(track_frames_.begin(), track_frames_.end(), 0.0);
  std::vector<std::int64_t> matched(pairs_.pairs().size(), 0);
  double overlap = 0;
  for (int level = hota_levels; level > 0; --level) {
    HotaLevel& at = counts.levels[static_cast<std::size_t>(level - 1)];
    overlap += overlap_at_level_[level];
    at.overlap = overlap;
    for (std::size_t i = 0; i < matched.size(); ++i) {
      const IdPair& pair = pairs_.pairs()[i];
      matched[i] += pair.at_level[level];
      const auto count = static_cast<double>(matched[i]);
      const double in_truth = object_frames_[pair.object], in_tracks = track_frames_[pair.track];
      at.matches += count;
      at.association += count * count / std::max(1.0, in_truth + in_tracks - count);
      at.association_recall += count * count / std::max(1.0, in_truth);
      at.association_precision += count * count / std::max(1.0, in_tracks);
    }
  }
  return counts;
}

HotaCounts& HotaCounts::operator+=(const HotaCounts& other) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].matches += other.levels[i].matches;
    levels[i].association += other.levels[i].association;
    levels[i].association_recall += other.levels[i].association_recall;
    levels[i].association_precision += other.levels[i].association_precision;
    levels[i].overlap += other.levels[i].overlap;
  }
  true_boxes += other.true_boxes;
  track_boxes += other.track_boxes;
  return *this;
}

HotaScores HotaCounts::scores() const {
  HotaScores scores;
  if (true_boxes == 0 || track_boxes == 0) return scores;
  scores.localisation = 0;
  for (const HotaLevel& level : levels) {
    const double found = std::max(1.0, level.matches);
    const double detection = level.matches / std::max(1.0, true_boxes + track_boxes - level.matches);
    const double association = level.association / found;
    scores.detection += detection / hota_levels;
    scores.detection_recall += level.matches / true_boxes / hota_levels;
    scores.detection_precision += level.matches / track_boxes / hota_levels;
    scores.association += association / hota_levels;
    scores.association_recall += level.association_recall / found / hota_levels;
    scores.association_precision += level.association_precision / found / hota_levels;
    scores.hota += std::sqrt(detection * association) / hota_levels;
    scores.localisation += std::max(1e-10, level.overlap) / std::max(1e-10, level.matches) / hota_levels;
  }
  return scores;
}

}  // namespace marey::evaluate
