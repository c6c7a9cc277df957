#pragma once

#include <span>
#include <vector>

#include "marey/evaluate/clear.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/frame_walk.h"
#include "marey/evaluate/hota.h"
#include "marey/evaluate/pair_table.h"

namespace marey::evaluate {

/// The scores, and what happened to each object.
struct Evaluated {
  Evaluation scores;
  std::vector<ClearCounter::Object> objects;
  std::vector<int> track_of_object;    ///< the one that the identity scores give each; assign::kNoIndex where none
  std::vector<std::int64_t> agreeing;  ///< in how many frames that track found the object
};

/// Counts the pairs of this frame that are near enough to be a match.
void count_found(const FramePairs& frame, double most_distance, PairTable& pairs);

/// Fills in the identity scores: one track for each object permanently, so that the most things agree. `evaluated.scores` has its
/// sizes.
void evaluate_identities(const PairTable& pairs, Evaluated& evaluated);

/// Every score of tracks against truth, whatever is compared: `close` says how alike two things are, and those up to
/// `most_distance` apart may match. `matched(walk, clear)` sees each frame once its matches are known.
template <Labelled Item, typename Close, typename Matched>
Evaluated assess(std::span<const Item> truth, std::span<const Item> tracks, double most_distance, Close close, Matched matched,
                 const Limits& limits = Limits::in_force()) {
  const IdNumbers objects(truth);
  const IdNumbers track_numbers(tracks);
  Evaluated evaluated;
  Evaluation& result = evaluated.scores;
  result.true_boxes = static_cast<std::int64_t>(truth.size());
  result.track_boxes = static_cast<std::int64_t>(tracks.size());
  result.objects = objects.count();
  result.tracks = track_numbers.count();

  PairTable pairs(objects.count());
  ClearCounter clear(objects.count(), track_numbers.count(), most_distance);
  HotaCounter hota(objects.count(), track_numbers.count(), pairs);
  for (FrameWalk<Item, Close> frame(truth, tracks, objects, track_numbers, close, limits); frame.next();) {
    ++result.frames;
    if (frame.has_both()) ++result.common_frames;
    clear.add(frame);
    matched(frame, clear);
    count_found(frame, most_distance, pairs);
    hota.observe_frame(frame);
  }
  hota.align();
  for (FrameWalk<Item, Close> frame(truth, tracks, objects, track_numbers, close, limits); frame.next();) hota.match(frame);

  result.clear = clear.scores();
  evaluate_identities(pairs, evaluated);
  result.hota = hota.counts().scores();
  evaluated.objects = clear.objects();
  return evaluated;
}

}  // namespace marey::evaluate
