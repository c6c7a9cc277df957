#include "marey/evaluate/evaluate_tracks.h"

#include <algorithm>
#include <cmath>

#include "marey/assign/gated_assignment.h"

namespace marey::evaluate {

void count_found(const FramePairs& frame, double most_distance, PairTable& pairs) {
  for (std::size_t row = 0; row < frame.objects().size(); ++row) {
    const auto distances = frame.distances_of(row);
    for (std::size_t column = 0; column < distances.size(); ++column) {
      if (distances[column] > most_distance) continue;
      ++pairs.at(frame.objects()[row], frame.tracks()[column]).found;
    }
  }
}

void evaluate_identities(const PairTable& pairs, Evaluated& evaluated) {
  const Evaluation& sizes = evaluated.scores;
  // Few rows are cheaper than few columns.
  const bool flip = sizes.objects > sizes.tracks;
  std::vector<assign::GatedPair> gated;
  for (const IdPair& pair : pairs.pairs()) {
    if (pair.found == 0) continue;
    const auto gain = static_cast<double>(pair.found);
    gated.push_back(flip ? assign::GatedPair{pair.track, pair.object, gain} : assign::GatedPair{pair.object, pair.track, gain});
  }
  assign::GatedAssigner assigner;
  const auto rows = static_cast<int>(std::min(sizes.objects, sizes.tracks));
  const auto columns = static_cast<int>(std::max(sizes.objects, sizes.tracks));
  const auto column_of_row = assigner.assign(rows, columns, gated);
  evaluated.track_of_object.assign(static_cast<std::size_t>(sizes.objects), assign::kNoIndex);
  evaluated.agreeing.assign(static_cast<std::size_t>(sizes.objects), 0);
  IdentityScores scores;
  for (const assign::GatedPair& pair : gated) {
    if (column_of_row[pair.row] != pair.column) continue;
    const auto object = static_cast<std::size_t>(flip ? pair.column : pair.row);
    evaluated.track_of_object[object] = flip ? pair.row : pair.column;
    evaluated.agreeing[object] = std::llround(pair.gain);
    scores.true_positives += evaluated.agreeing[object];
  }
  scores.false_negatives = sizes.true_boxes - scores.true_positives;
  scores.false_positives = sizes.track_boxes - scores.true_positives;
  const auto agreeing = static_cast<double>(scores.true_positives);
  if (sizes.track_boxes > 0) scores.precision = agreeing / static_cast<double>(sizes.track_boxes);
  if (sizes.true_boxes > 0) scores.recall = agreeing / static_cast<double>(sizes.true_boxes);
  const auto things = static_cast<double>(sizes.true_boxes + sizes.track_boxes);
  if (things > 0) scores.f1 = 2 * agreeing / things;
  evaluated.scores.identity = scores;
}

}  // namespace marey::evaluate
