#include "marey/solve/labels/find_names.h"

#include <algorithm>
#include <string>
#include <vector>

namespace marey::solve::labels {
namespace {

constexpr std::size_t kMaxInspected = 200;  // instants at which distances are taken

/// The named tracks by name; null where a name was not found.
std::vector<const TrackColumns*> named_tracks(const Recording& labelled, const LearnedMarkers& learned) {
  std::map<std::string, const TrackColumns*> by_label;
  for (const TrackColumns& track : labelled.tracks()) {
    if (!track.name.label.empty() && !track.empty()) by_label[track.name.label] = &track;
  }
  std::vector<const TrackColumns*> tracks;
  for (const std::string& label : learned.labels) {
    const auto found = by_label.find(label);
    tracks.push_back(found == by_label.end() ? nullptr : found->second);
  }
  return tracks;
}

std::vector<DistanceObserved> distances_of(const std::vector<const TrackColumns*>& tracks, std::size_t instants) {
  std::vector<DistanceObserved> detected(tracks.size() * (tracks.size() - 1) / 2);
  const std::size_t step = std::max<std::size_t>(1, instants / kMaxInspected);
  for (std::size_t instant = 0; instant < instants; instant += step) {
    std::vector<std::optional<Vector<3>>> locations;
    for (const TrackColumns* track : tracks) {
      const auto row = track == nullptr ? std::nullopt : track->row_at(static_cast<std::int32_t>(instant));
      locations.push_back(row ? std::optional(track->position(*row)) : std::nullopt);
    }
    for (std::size_t a = 1; a < locations.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!locations[a] || !locations[b]) continue;
        const double distance = (*locations[a] - *locations[b]).norm();
        DistanceObserved& pair = detected[LearnedMarkers::index_of(a, b)];
        const double fraction = 1.0 / ++pair.count, off = distance - pair.mean;
        pair.mean += fraction * off;
        pair.variance += fraction * ((1 - fraction) * off * off - pair.variance);
      }
    }
  }
  return detected;
}

}  // namespace

FoundNames find_names(const Recording& recent, const LearnedMarkers& learned, const LabelOptions& options,
                      const LabelTrackerOptions& tracking, const Hooks& hooks) {
  LabelOptions as_taught = options;
  as_taught.scale_to_person = false;  // some seconds are too little for it
  const Labelled labelled = label_recording(recent, learned, as_taught, hooks);
  const std::vector<const TrackColumns*> named = named_tracks(labelled.recording, learned);
  FoundNames found;
  found.scale = labelled.scale;
  found.undecided = labelled.undecided;
  for (const TrackColumns* track : named) found.decided.push_back(track == nullptr ? 0 : 1);
  for (const Unnamed& piece : labelled.unnamed) {
    const auto best = std::find(learned.labels.begin(), learned.labels.end(), piece.best);
    if (best == learned.labels.end()) continue;
    const auto name = static_cast<std::size_t>(best - learned.labels.begin());
    if (!found.decided[name]) found.undecided[name] = 1;
  }
  found.misfit = labelled.misfit;
  found.misfit_m = labelled.misfit_m;
  for (const TrackColumns& track : recent.tracks()) {
    if (track.empty()) continue;
    const std::int32_t last = track.at().back();
    for (std::size_t name = 0; name < named.size(); ++name) {
      const auto row = named[name] == nullptr ? std::nullopt : named[name]->row_at(last);
      if (row && named[name]->position(*row) == track.position(track.size() - 1))
        found.name_of[track.id()] = static_cast<int>(name);
    }
  }
  // Two pieces of one marker have its name, each in its time: the one that is there last has it.
  std::map<int, std::pair<std::int32_t, TrackId>> latest;
  for (const auto& [track, name] : found.name_of) {
    const std::pair its(recent.find(track)->at().back(), track);
    const auto [bearer, is_first] = latest.try_emplace(name, its);
    if (!is_first && bearer->second < its) bearer->second = its;
  }
  std::erase_if(found.name_of, [&](const auto& each) { return latest.at(each.second).second != each.first; });
  found.tracker = std::make_unique<LabelTracker>(learned, labelled.scale, distances_of(named, recent.instants().size()), tracking);
  return found;
}

}  // namespace marey::solve::labels
