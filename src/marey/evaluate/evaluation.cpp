#include "marey/evaluate/evaluation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/evaluate/clear.h"
#include "marey/evaluate/frame_walk.h"
#include "marey/evaluate/hota.h"
#include "marey/evaluate/pair_table.h"

namespace marey {
namespace {

[[maybe_unused]] bool by_frame(const LabelledBox& a, const LabelledBox& b) {
  return a.frame < b.frame;
}

void count_found(const FrameWalk& frame, double least_overlap, PairTable& pairs) {
  for (std::size_t row = 0; row < frame.objects().size(); ++row) {
    const auto overlaps = frame.overlaps_of(row);
    for (std::size_t column = 0; column < overlaps.size(); ++column) {
      // Written as the reference has it: its rounding decides draws.
      if (1 - overlaps[column] > 1 - least_overlap) continue;
      ++pairs.at(frame.objects()[row], frame.tracks()[column]).found;
    }
  }
}

/// One track for each object for good, so that the most boxes agree.
IdentityScores identity_scores(const Evaluation& sizes, const PairTable& pairs) {
  // Few rows are cheaper than few columns.
  const bool flip = sizes.objects > sizes.tracks;
  std::vector<GatedPair> gated;
  for (const IdPair& pair : pairs.pairs()) {
    if (pair.found == 0) continue;
    const auto gain = static_cast<double>(pair.found);
    gated.push_back(flip ? GatedPair{pair.track, pair.object, gain} : GatedPair{pair.object, pair.track, gain});
  }
  GatedAssigner assigner;
  const auto rows = static_cast<int>(std::min(sizes.objects, sizes.tracks));
  const auto columns = static_cast<int>(std::max(sizes.objects, sizes.tracks));
  const auto column_of_row = assigner.assign(rows, columns, gated);
  IdentityScores scores;
  for (const GatedPair& pair : gated) {
    if (column_of_row[pair.row] == pair.column) scores.true_positives += std::llround(pair.gain);
  }
  scores.false_negatives = sizes.true_boxes - scores.true_positives;
  scores.false_positives = sizes.track_boxes - scores.true_positives;
  const auto agreeing = static_cast<double>(scores.true_positives);
  if (sizes.track_boxes > 0) scores.precision = agreeing / static_cast<double>(sizes.track_boxes);
  if (sizes.true_boxes > 0) scores.recall = agreeing / static_cast<double>(sizes.true_boxes);
  const auto boxes = static_cast<double>(sizes.true_boxes + sizes.track_boxes);
  if (boxes > 0) scores.f1 = 2 * agreeing / boxes;
  return scores;
}

}  // namespace

Evaluation evaluate(std::span<const LabelledBox> truth, std::span<const LabelledBox> tracks, double least_overlap) {
  assert(std::is_sorted(truth.begin(), truth.end(), by_frame) && "truth is ordered by frame");
  assert(std::is_sorted(tracks.begin(), tracks.end(), by_frame) && "tracks are ordered by frame");
  assert(least_overlap > 0 && least_overlap <= 1 && "an overlap from which a box counts as found");
  const IdNumbers objects(truth);
  const IdNumbers track_numbers(tracks);
  Evaluation result;
  result.true_boxes = static_cast<std::int64_t>(truth.size());
  result.track_boxes = static_cast<std::int64_t>(tracks.size());
  result.objects = objects.count();
  result.tracks = track_numbers.count();

  PairTable pairs(objects.count());
  ClearCounter clear(objects.count(), track_numbers.count(), least_overlap);
  HotaCounter hota(objects.count(), track_numbers.count(), pairs);
  for (FrameWalk frame(truth, tracks, objects, track_numbers); frame.next();) {
    ++result.frames;
    if (!frame.overlaps().empty()) ++result.common_frames;
    clear.add(frame);
    count_found(frame, least_overlap, pairs);
    hota.see(frame);
  }
  hota.align();
  for (FrameWalk frame(truth, tracks, objects, track_numbers); frame.next();) hota.match(frame);

  result.clear = clear.scores();
  result.identity = identity_scores(result, pairs);
  result.hota = hota.scores();
  return result;
}

}  // namespace marey
