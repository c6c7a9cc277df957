#include "marey/track/roster/roster_decisions.h"

#include <algorithm>
#include <utility>

namespace marey::track::roster {

template <int D>
void RosterDecisions<D>::add(Timestamp now, std::span<const Track<D>> tracks) {
  held_.push_back({now, {tracks.begin(), tracks.end()}, {}});
}

template <int D>
void RosterDecisions<D>::rename(std::span<const RenamedTrack> renamed) {
  for (const RenamedTrack& one : renamed) {
    for (auto frame = held_.rbegin(); frame != held_.rend() && frame->now >= one.since; ++frame) rename(*frame, one);
  }
}

/// The old name's own row goes where it was only expected; where it was seen elsewhere at that instant, it keeps what it has.
template <int D>
void RosterDecisions<D>::rename(Held& frame, const RenamedTrack& renamed) {
  auto& tracks = frame.tracks;
  const auto row_of = [&](TrackId id) {
    return std::find_if(tracks.begin(), tracks.end(), [&](const Track<D>& track) { return track.id == id; });
  };
  const auto from = row_of(renamed.from);
  if (from == tracks.end()) return;
  if (renamed.from == renamed.to) {
    from->confirmed = true;
    return;
  }
  if (!from->observation) return;
  Track<D> moved = *from;
  moved.id = renamed.to;
  if (const auto to = row_of(renamed.to); to != tracks.end()) {
    if (to->observation) return;
    moved.label = to->label;
    moved.confirmed = to->confirmed;
    tracks.erase(to);
  } else {
    moved.label.clear();
  }
  tracks.erase(row_of(renamed.from));
  tracks.insert(std::find_if(tracks.begin(), tracks.end(), [&](const Track<D>& track) { return moved.id < track.id; }),
                std::move(moved));
}

template <int D>
std::span<const Decision<D>> RosterDecisions<D>::take(bool all) {
  taken_.clear();
  decisions_.clear();
  while (!held_.empty() && (all || seconds(held_.back().now - held_.front().now) >= after_)) {
    taken_.push_back(std::move(held_.front()));
    held_.pop_front();
  }
  for (Held& frame : taken_) {
    for (const Track<D>& track : frame.tracks) {
      if (track.observation) frame.matches.push_back({track.id, 0, *track.observation});
    }
    decisions_.push_back({frame.now, frame.tracks, frame.matches});
  }
  return decisions_;
}

template class RosterDecisions<2>;
template class RosterDecisions<3>;

}  // namespace marey::track::roster
