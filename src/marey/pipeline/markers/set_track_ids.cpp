#include "marey/pipeline/markers/set_track_ids.h"

#include "marey/assign/no_index.h"

namespace marey::pipeline::markers {

TrackId SetTrackIds::own_or_fresh(TrackId track) {
  if (used_.insert(track).second) return track;
  const TrackId id{number(*used_.rbegin()) + 1};
  used_.insert(id);
  return id;
}

TrackId SetTrackIds::id_of(TrackId track, int label) {
  const auto own = of_track_.find(track);
  if (label == assign::kNoIndex) {
    if (own != of_track_.end()) return own->second;
    const TrackId id = own_or_fresh(track);
    of_track_.emplace(track, id);
    return id;
  }
  auto& id = of_label_[static_cast<std::size_t>(label)];
  if (!id && own != of_track_.end()) {  // the track's ID is the label's from now on
    id = own->second;
    of_track_.erase(own);
  } else if (!id) {
    id = own_or_fresh(track);
  }
  return *id;
}

bool SetTrackIds::report(const TrackName& track) {
  const auto [known, is_new] = reported_.try_emplace(track.id, track);
  if (!is_new && known->second == track) return false;
  known->second = track;
  return true;
}

}  // namespace marey::pipeline::markers
