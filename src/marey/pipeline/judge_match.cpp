// Judging tracks on the ground: which instants of the two recordings are the same, then the comparison place by place, then the
// paths' lengths. A recording's period is the median time between two of its instants.
#include "marey/pipeline/judge_match.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "marey/analyse/smooth_path.h"

namespace marey::pipeline {
namespace {

constexpr double kSlowest = 0.25;  // s between instants up to which a way between them is known
constexpr double kSame = 0.02;     // share by which periods may differ and still be one

struct Clock {
  const std::vector<Recording::Moment>& instants;
  double period = 0;   // s between instants; 0 where there are fewer than two
  double frame_s = 0;  // s a frame number

  double time(std::size_t i) const { return seconds(instants[i].time); }
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

Clock clock_of(const Recording& recording) {
  Clock clock{recording.instants()};
  std::vector<double> steps, per_frame;
  for (std::size_t i = 1; i < clock.instants.size(); ++i) {
    const double step = clock.time(i) - clock.time(i - 1);
    steps.push_back(step);
    per_frame.push_back(step / static_cast<double>(clock.instants[i].index - clock.instants[i - 1].index));
  }
  clock.period = median(std::move(steps));
  clock.frame_s = median(std::move(per_frame));
  return clock;
}

bool alike(double a, double b) {
  return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b));
}

/// Which of `others` is the same instant: index into it.
std::vector<std::optional<std::size_t>> partners(const Clock& clock, const Clock& others, bool by_time) {
  std::vector<std::optional<std::size_t>> result;
  const auto key = [by_time](const Recording::Moment& moment) {
    return by_time ? seconds(moment.time) : static_cast<double>(moment.index);
  };
  const double reach = by_time ? std::min(clock.period, others.period) / 2 + 1e-9 : 0;
  const auto begin = others.instants.begin(), end = others.instants.end();
  for (const Recording::Moment& moment : clock.instants) {
    auto next = std::lower_bound(begin, end, key(moment), [&](const Recording::Moment& a, double b) { return key(a) < b; });
    if (next != begin && (next == end || key(*next) - key(moment) > key(moment) - key(*(next - 1)))) --next;
    const bool near = next != end && std::abs(key(*next) - key(moment)) <= reach;
    result.push_back(near ? std::optional(static_cast<std::size_t>(next - begin)) : std::nullopt);
  }
  return result;
}

/// The common number of each instant of a recording; those that are not judged have none.
using Numbers = std::vector<std::optional<std::int32_t>>;

struct Pairing {
  Numbers truth, tracks;
  bool by_time = false;
};

/// Numbers in the order of `leader`'s instants, given to `follower`'s partners too. Where `all`, the follower's instants that have
/// no partner get numbers of their own.
void number(const Clock& leader, const Clock& follower, bool by_time, bool all, Numbers& leading, Numbers& following) {
  const auto partner = partners(leader, follower, by_time);
  leading.assign(leader.instants.size(), std::nullopt);
  following.assign(follower.instants.size(), std::nullopt);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < leading.size(); ++i) {
    leading[i] = next;
    if (partner[i] && !following[*partner[i]]) following[*partner[i]] = next;
    ++next;
  }
  for (std::size_t i = 0; all && i < following.size(); ++i) {
    if (!following[i]) following[i] = next++;
  }
}

/// How much later the tracks' first common frame is than the truth's, s; 0 where there is none.
double time_between(const Clock& truth, const Clock& tracks) {
  const auto partner = partners(truth, tracks, false);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i]) return tracks.time(*partner[i]) - truth.time(i);
  }
  return 0;
}

Pairing pair_instants(const Clock& truth, const Clock& tracks, std::vector<std::string>& warnings) {
  Pairing pairing;
  const bool known = truth.period > 0 && tracks.period > 0;
  pairing.by_time = known && !alike(truth.frame_s, tracks.frame_s);
  if (!known || alike(truth.period, tracks.period)) {
    number(truth, tracks, pairing.by_time, true, pairing.truth, pairing.tracks);
  } else {
    const bool truth_leads = truth.period > tracks.period;
    if (truth_leads) {
      number(truth, tracks, pairing.by_time, false, pairing.truth, pairing.tracks);
    } else {
      number(tracks, truth, pairing.by_time, false, pairing.tracks, pairing.truth);
    }
    warnings.push_back(fmt::format("the truth has an instant every {:.3g} s, the tracks every {:.3g} s; judged are those of {}",
                                   truth.period, tracks.period, truth_leads ? "the truth" : "the tracks"));
  }
  if (const double apart = pairing.by_time ? 0 : time_between(truth, tracks);
      std::abs(apart) > std::max(truth.period, tracks.period))
    warnings.push_back(fmt::format(
        "the same frame is {:.3g} s later in the tracks than in the truth; instants are paired by frame all the same", apart));
  if (pairing.by_time)
    warnings.push_back(
        "frame numbers mean other times in the two files; instants are paired by time, the nearest within half a period");
  return pairing;
}

/// A velocity of each row of a track: as recorded, else of smoothed paths. What is on no path, because it stands alone, has none.
using Velocities = std::vector<std::optional<Vector<2>>>;

Velocities velocities_of(const Recording& recording, const TrackColumns& track, bool recorded) {
  Velocities velocities(track.size());
  if (recorded) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      if (const auto velocity = track.velocity(row)) velocities[row] = velocity->head<2>();
    }
    return velocities;
  }
  const std::vector<analyse::Path> paths = analyse::paths_of(recording, track);
  for (std::size_t row = 0; row < track.size(); ++row) {
    const double time = recording.seconds_at(static_cast<std::size_t>(track.at()[row]));
    for (const analyse::Path& path : paths) {
      const double at = (time - path.start_s) / path.step_s;
      if (at < -0.5 || at > static_cast<double>(path.velocity.size()) - 0.5) continue;
      const auto nearest = static_cast<std::size_t>(std::max(0.0, std::round(at)));
      velocities[row] = path.velocity[std::min(nearest, path.velocity.size() - 1)];
    }
  }
  return velocities;
}

std::vector<evaluate::PersonPlace> places_of(const Recording& recording, const Numbers& numbers) {
  const bool recorded = has_velocities(recording);
  std::vector<Velocities> velocities;
  for (const TrackColumns& track : recording.tracks()) velocities.push_back(velocities_of(recording, track, recorded));
  std::vector<evaluate::PersonPlace> places;
  places.reserve(static_cast<std::size_t>(recording.samples()));
  InstantRows rows(recording);
  for (std::size_t instant = 0; instant < numbers.size(); ++instant) {
    if (!numbers[instant]) continue;
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = recording.tracks()[index];
      places.push_back({*numbers[instant], marey::number(track.id()), track.place(row), velocities[index][row]});
    }
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return places;
}

struct PathColumns {
  std::vector<double> x, y;

  void add(const Vector<2>& place) { x.push_back(place.x()), y.push_back(place.y()); }

  double length(const std::vector<double>& times) const {
    double length = 0;
    for (const analyse::Path& path : analyse::smooth_paths(times, x, y)) {
      for (std::size_t i = 1; i < path.place.size(); ++i) length += (path.place[i] - path.place[i - 1]).norm();
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
std::vector<PathLengths> path_lengths(const std::vector<evaluate::PersonPlace>& truth,
                                      const std::vector<evaluate::PersonPlace>& tracks,
                                      const std::vector<evaluate::PersonFate>& people,
                                      const std::map<std::int32_t, double>& times) {
  std::map<int, int> track_of;
  for (const evaluate::PersonFate& person : people) {
    if (person.track) track_of[person.id] = *person.track;
  }
  std::map<int, SharedPath> shared;
  std::size_t begin = 0;  // of the tracks' places in this frame
  for (const evaluate::PersonPlace& place : truth) {
    while (begin < tracks.size() && tracks[begin].frame < place.frame) ++begin;
    const auto track = track_of.find(place.id);
    if (track == track_of.end()) continue;
    std::size_t theirs = begin;
    while (theirs < tracks.size() && tracks[theirs].frame == place.frame && tracks[theirs].id != track->second) ++theirs;
    if (theirs == tracks.size() || tracks[theirs].frame != place.frame) continue;
    SharedPath& path = shared[place.id];
    path.times.push_back(times.at(place.frame));
    path.truth.add(place.place);
    path.track.add(tracks[theirs].place);
  }
  std::vector<PathLengths> lengths;
  for (const auto& [id, path] : shared) lengths.push_back({id, path.truth.length(path.times), path.track.length(path.times)});
  return lengths;
}

}  // namespace

MatchJudgement judge_match(const Recording& truth, const Recording& tracks, double farthest) {
  require_ground(truth, "judging places");
  require_ground(tracks, "judging places");
  MatchJudgement judgement;
  const Clock true_clock = clock_of(truth), track_clock = clock_of(tracks);
  const Pairing pairing = pair_instants(true_clock, track_clock, judgement.warnings);
  judgement.by_time = pairing.by_time;
  const auto moving = [](const Recording& recording, const Clock& clock) {
    return has_velocities(recording) || (clock.period > 0 && clock.period <= kSlowest);
  };
  const std::vector<evaluate::PersonPlace> true_places = places_of(truth, pairing.truth),
                                           track_places = places_of(tracks, pairing.tracks);
  judgement.evaluation = evaluate::evaluate_ground(true_places, track_places, farthest);
  judgement.has_speed = moving(truth, true_clock) && moving(tracks, track_clock);
  const double period = std::max(true_clock.period, track_clock.period);
  if (period > 0 && period <= kSlowest) {
    std::map<std::int32_t, double> times;
    for (std::size_t i = 0; i < pairing.truth.size(); ++i) {
      if (pairing.truth[i]) times[*pairing.truth[i]] = true_clock.time(i);
    }
    judgement.ways = path_lengths(true_places, track_places, judgement.evaluation.people, times);
    double error = 0, length = 0;
    for (const PathLengths& way : judgement.ways) error += std::abs(way.track_m - way.true_m), length += way.true_m;
    if (length > 0) judgement.distance_error = error / length;
  }
  return judgement;
}

}  // namespace marey::pipeline
