// Which pieces of tracklets are one target's.
//
// A piece that ends and one that begins are one target's where they fit as one walking person's would: the mean velocity over the
// gap fits the velocities before and after it, the size is the same, and so are the clothes, where they were seen. Every end and
// every beginning takes part in one assignment that maximises the sum of log-likelihood ratios against one who left and another who
// came. Out of a meeting any of those who went in may come; the one that the tracker chose has some prior weight.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/track/image/clothing.h"
#include "marey/track/offline/ambiguous_intervals.h"
#include "marey/track/offline/join.h"

namespace marey::track::offline {

class TrackletLinker {
 public:
  /// Learns from `tracklets` what clothes say, and marks their rows that are uncertain. `log` and `options` must outlive it.
  TrackletLinker(std::span<TrackletLog::Tracklet> tracklets, const TrackletLog& log, const JoinOptions& options);

  /// Joins tracklets over gaps of at most this many seconds.
  std::vector<TrackletLog::Tracklet> join(std::vector<TrackletLog::Tracklet> tracklets, double longest_gap) const;

  /// Whether clothes were seen for long enough, of enough people, to be informative.
  bool knows_clothes() const { return clothes_.learned(); }

  /// Cuts tracklets wherever their identity is uncertain, and links the pieces again.
  std::vector<TrackletLog::Tracklet> decide_again(std::vector<TrackletLog::Tracklet> tracklets) const;

 private:
  struct End;
  struct Line;
  /// How one piece comes after another: out of nowhere, out of the meeting that the other went into, or as the tracker had it.
  enum class Passage { apart, through_encounter, as_tracked };

  std::vector<TrackletLog::Tracklet> link(std::vector<TrackletPiece> pieces, double longest_gap) const;
  End end_of(const TrackletPiece& piece, bool tail) const;
  std::vector<assign::GatedPair> candidates(std::span<const TrackletPiece> pieces, double longest_gap) const;
  static Passage passage_of(std::span<const TrackletPiece> pieces, int tail, int head);
  double score_of(const End& tail, const End& head, Passage passage) const;
  double gain(const End& tail, const End& head) const;
  double time_of(const TrackRow& row) const { return seconds(log_.time_of(row.frame)); }

  const TrackletLog& log_;
  const JoinOptions& options_;
  image::ClothesLikelihood clothes_;
};

}  // namespace marey::track::offline
