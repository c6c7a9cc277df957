#include "marey/solve/labels/accept_suggestions.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace marey::solve::labels {
namespace {

bool is_within(const Unnamed& piece, std::int32_t instant) {
  return piece.first <= instant && instant <= piece.last;
}

/// The rows of one track that are, or are not, of a piece.
TrackColumns rows_of(const TrackColumns& track, const Unnamed& piece, bool within) {
  TrackColumns rows(track.name, track.dimensions());
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (is_within(piece, track.at()[row]) == within) rows.add(track.at()[row], track.sample(row));
  }
  return rows;
}

/// Two tracks that are never there together, as one by the first one's name.
TrackColumns merged(const TrackColumns& one, const TrackColumns& other) {
  TrackColumns both(one.name, one.dimensions());
  std::size_t a = 0, b = 0;
  while (a < one.size() || b < other.size()) {
    const bool first = b == other.size() || (a < one.size() && one.at()[a] < other.at()[b]);
    const TrackColumns& from = first ? one : other;
    const std::size_t row = first ? a++ : b++;
    Sample sample = from.sample(row);
    sample.track = one.id();
    both.add(from.at()[row], sample);
  }
  return both;
}

const TrackColumns* track_called(const Recording& recording, const std::string& label) {
  const auto found = std::find_if(recording.tracks().begin(), recording.tracks().end(),
                                  [&](const TrackColumns& track) { return track.name.label == label; });
  return found == recording.tracks().end() ? nullptr : &*found;
}

/// False if another point has the name at the time.
bool give_name(Labelled& labelled, const Unnamed& piece) {
  const TrackColumns* const named = track_called(labelled.recording, piece.best);
  const TrackColumns* const from = labelled.recording.find(piece.track);
  if (named == nullptr || from == nullptr) return false;
  if (std::any_of(named->at().begin(), named->at().end(), [&](std::int32_t at) { return is_within(piece, at); })) return false;
  const TrackColumns rows = rows_of(*from, piece, true);
  TrackColumns rest = rows_of(*from, piece, false), whole = merged(*named, rows);
  for (MarkerHealth& health : labelled.health) {
    if (health.label == piece.best) health.detected += static_cast<std::int64_t>(rows.size());
  }
  labelled.recording.put(std::move(rest));
  labelled.recording.put(std::move(whole));
  return true;
}

}  // namespace

std::int64_t accept_suggestions(Labelled& labelled, const std::vector<std::string>& names) {
  std::vector<Unnamed> pieces = std::exchange(labelled.unnamed, {});
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Unnamed& a, const Unnamed& b) { return a.last - a.first > b.last - b.first; });
  std::int64_t accepted = 0;
  for (const Unnamed& piece : pieces) {
    const bool meant = !piece.best.empty() && (names.empty() || std::find(names.begin(), names.end(), piece.best) != names.end());
    if (meant && give_name(labelled, piece)) {
      ++accepted;
    } else {
      labelled.unnamed.push_back(piece);
    }
  }
  labelled.recording.erase_tracks_if([](const TrackColumns& track) { return track.name.label.empty() && track.empty(); });
  return accepted;
}

}  // namespace marey::solve::labels
