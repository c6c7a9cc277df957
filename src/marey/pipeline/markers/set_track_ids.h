// The IDs under which labelled tracks are reported: a label has one, whichever tracks its marker had.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "marey/core/instant.h"

namespace marey::pipeline::markers {

class SetTrackIds {
 public:
  explicit SetTrackIds(std::size_t labels) : of_label_(labels) {}

  /// Of a track with this label (its index, or assign::kNoIndex): its own as far as no other has it. A label takes the ID of the
  /// first track that has it.
  TrackId id_of(TrackId track, int label);
  /// Whether the track is reported without a label.
  bool is_unlabelled(TrackId track) const { return of_track_.contains(track); }
  /// Whether this was not reported yet; it counts as reported then.
  bool report(const TrackName& track);

 private:
  TrackId own_or_fresh(TrackId track);

  std::vector<std::optional<TrackId>> of_label_;
  std::map<TrackId, TrackId> of_track_;  // of those without a label
  std::set<TrackId> used_;
  std::map<TrackId, TrackName> reported_;
};

}  // namespace marey::pipeline::markers
