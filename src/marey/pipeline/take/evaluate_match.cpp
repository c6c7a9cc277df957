// Judging tracks on the ground, or in space: which instants of the two recordings are the same, then the comparison place by place,
// then the paths' lengths. A recording's period is the median time between two of its instants.
#include "marey/pipeline/take/evaluate_match.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "marey/analyse/smooth_path.h"
#include "marey/core/error.h"
#include "marey/evaluate/pair_instants.h"

namespace marey::pipeline::take {
namespace {

constexpr double kSlowest = 0.25;  // s between instants up to which a path between them is known

/// On the ground: they have paths that are smoothed and added up.
bool of_people(const Recording& recording) {
  return recording.header.frame.dimensions() == 2;
}

/// A velocity of each row of a track: as recorded, else, of people, of smoothed paths. What is on no path, because it stands alone,
/// has none.
using Velocities = std::vector<std::optional<Vector<3>>>;

Velocities velocities_of(const Recording& recording, const TrackColumns& track, bool recorded) {
  Velocities velocities(track.size());
  if (recorded) {
    for (std::size_t row = 0; row < track.size(); ++row) velocities[row] = track.velocity(row);
    return velocities;
  }
  if (!of_people(recording)) return velocities;
  const std::vector<analyse::Path> paths = analyse::paths_of(recording, track).paths;
  for (std::size_t row = 0; row < track.size(); ++row) {
    const double time = recording.seconds_at(static_cast<std::size_t>(track.at()[row]));
    for (const analyse::Path& path : paths) {
      const double at = (time - path.start_s) / path.step_s;
      if (at < -0.5 || at > static_cast<double>(path.velocity.size()) - 0.5) continue;
      const auto nearest = static_cast<std::size_t>(std::max(0.0, std::round(at)));
      velocities[row] = evaluate::on_ground(path.velocity[std::min(nearest, path.velocity.size() - 1)]);
    }
  }
  return velocities;
}

std::vector<evaluate::TargetPosition> positions_of(const Recording& recording, const evaluate::CommonNumbers& numbers) {
  const bool recorded = has_velocities(recording);
  std::vector<Velocities> velocities;
  for (const TrackColumns& track : recording.tracks()) velocities.push_back(velocities_of(recording, track, recorded));
  std::vector<evaluate::TargetPosition> locations;
  locations.reserve(static_cast<std::size_t>(recording.samples()));
  InstantRows rows(recording);
  for (std::size_t instant = 0; instant < numbers.size(); ++instant) {
    if (!numbers[instant]) continue;
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = recording.tracks()[index];
      if (track.name.kind == TrackKind::ball) continue;  // not a person
      locations.push_back({*numbers[instant], marey::number(track.id()), track.position(row), velocities[index][row]});
    }
  }
  std::stable_sort(locations.begin(), locations.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return locations;
}

struct PathColumns {
  std::vector<double> x, y;

  void add(const Vector<3>& location) { x.push_back(location.x()), y.push_back(location.y()); }

  double length(const std::vector<double>& times) const {
    double length = 0;
    for (const analyse::Path& path : analyse::smooth_paths(times, x, y)) {
      for (std::size_t i = 1; i < path.location.size(); ++i) length += (path.location[i] - path.location[i - 1]).norm();
    }
    return length;
  }
};

struct SharedPath {
  std::vector<double> times;
  PathColumns truth, track;
};

/// The paths of people and of their tracks, over the instants that both have; `times` are those of the common numbers, by the
/// truth.
std::vector<PathLengths> path_lengths(const std::vector<evaluate::TargetPosition>& truth,
                                      const std::vector<evaluate::TargetPosition>& tracks,
                                      const std::vector<evaluate::TargetFate>& people,
                                      const std::map<std::int32_t, double>& times) {
  std::map<int, int> track_of;
  for (const evaluate::TargetFate& person : people) {
    if (person.track) track_of[person.id] = *person.track;
  }
  std::map<int, SharedPath> shared;
  std::size_t begin = 0;  // of the tracks' places in this frame
  for (const evaluate::TargetPosition& location : truth) {
    while (begin < tracks.size() && tracks[begin].frame < location.frame) ++begin;
    const auto track = track_of.find(location.id);
    if (track == track_of.end()) continue;
    std::size_t theirs = begin;
    while (theirs < tracks.size() && tracks[theirs].frame == location.frame && tracks[theirs].id != track->second) ++theirs;
    if (theirs == tracks.size() || tracks[theirs].frame != location.frame) continue;
    SharedPath& path = shared[location.id];
    path.times.push_back(times.at(location.frame));
    path.truth.add(location.location);
    path.track.add(tracks[theirs].location);
  }
  std::vector<PathLengths> lengths;
  for (const auto& [id, path] : shared) lengths.push_back({id, path.truth.length(path.times), path.track.length(path.times)});
  return lengths;
}

}  // namespace

MatchEvaluation evaluate_match(const Recording& truth, const Recording& tracks, double farthest) {
  require_metric(truth.header, "judging places");
  require_metric(tracks.header, "judging places");
  if (of_people(truth) != of_people(tracks))
    throw Error("{}: its positions are {}, those of {} are {}; both must be on the ground, or in space", tracks.header.name,
                to_string(tracks.header.frame), truth.header.name, to_string(truth.header.frame));
  MatchEvaluation judgement;
  const evaluate::InstantClock true_clock = evaluate::clock_of(truth), track_clock = evaluate::clock_of(tracks);
  const evaluate::InstantPairing pairing = evaluate::pair_instants(true_clock, track_clock);
  judgement.warnings = pairing.warnings;
  judgement.by_time = pairing.by_time;
  const auto moving = [](const Recording& recording, const evaluate::InstantClock& clock) {
    return has_velocities(recording) || (of_people(recording) && clock.period > 0 && clock.period <= kSlowest);
  };
  const std::vector<evaluate::TargetPosition> true_places = positions_of(truth, pairing.truth),
                                              track_places = positions_of(tracks, pairing.tracks);
  judgement.evaluation = evaluate::evaluate_ground(true_places, track_places, farthest);
  judgement.has_speed = moving(truth, true_clock) && moving(tracks, track_clock);
  const double period = std::max(true_clock.period, track_clock.period);
  if (of_people(truth) && period > 0 && period <= kSlowest) {
    std::map<std::int32_t, double> times;
    for (std::size_t i = 0; i < pairing.truth.size(); ++i) {
      if (pairing.truth[i]) times[*pairing.truth[i]] = true_clock.time(i);
    }
    judgement.path_lengths = path_lengths(true_places, track_places, judgement.evaluation.people, times);
    double error = 0, length = 0;
    for (const PathLengths& path : judgement.path_lengths) error += std::abs(path.track_m - path.true_m), length += path.true_m;
    if (length > 0) judgement.distance_error = error / length;
  }
  return judgement;
}

}  // namespace marey::pipeline::take
