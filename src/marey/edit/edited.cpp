#include "marey/edit/edited.h"

#include <map>
#include <utility>

#include "marey/edit/history.h"
#include "marey/edit/operation.h"
#include "marey/edit/tracks.h"
#include "marey/edit/turn_body.h"

namespace marey::edit {

Recording edited(Recording recorded) {
  const std::vector<Edit> branch = branch_of(recorded.edits, recorded.head);
  recorded.edits.clear();
  recorded.head.reset();
  if (branch.empty()) return recorded;

  std::vector<TrackName> names;
  for (const TrackColumns& track : recorded.tracks()) names.push_back(track.name);
  Tracks tracks(recorded.instants(), names, [&](TrackId track) { return *recorded.find(track); });
  for (const Edit& edit : branch) {
    const auto operation = operation_of(edit);
    if (!operation) continue;
    tracks.apply(*operation);
    if (operation->kind == Operation::Kind::turn) turn_body(recorded, *operation);
  }
  std::vector<TrackColumns> changed;
  for (const TrackName& name : tracks.names()) {
    if (tracks.changed(name.id)) changed.push_back(tracks.columns(name.id, recorded.dimensions()));
  }
  recorded.erase_tracks_if([&](const TrackColumns& track) { return !tracks.has(track.id()); });
  for (TrackColumns& track : changed) recorded.put(std::move(track));
  return recorded;
}

}  // namespace marey::edit
