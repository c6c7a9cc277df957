// Judging tracks on the ground: which instants of the two recordings are the same, then the comparison place by place, then the
// lengths of the paths.
#include "marey/pipeline/judge_match.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "marey/analyse/smooth_path.h"
#include "marey/evaluate/pair_instants.h"

namespace marey::pipeline {
namespace {

constexpr double kSlowest = 0.25;  // s between instants up to which a way between them is known
bool has_velocities(const GroundRecording& recording) {
  return std::any_of(recording.samples.begin(), recording.samples.end(),
                     [](const auto& sample) { return sample.velocity != Vector<2>::Zero(); });
}

/// Velocities of smoothed ways. What is on no way, because it stands alone, keeps 0.
GroundRecording with_velocities(GroundRecording recording) {
  std::vector<std::vector<std::size_t>> samples_of(recording.people.size());
  for (std::size_t i = 0; i < recording.samples.size(); ++i)
    samples_of[static_cast<std::size_t>(recording.samples[i].person)].push_back(i);
  for (const auto& mine : samples_of) {
    std::vector<analyse::TimedPlace> measured;
    for (const std::size_t i : mine) {
      const auto& sample = recording.samples[i];
      if (measured.empty() || sample.time > measured.back().time) measured.push_back({sample.time, sample.place});
    }
    const std::vector<analyse::Path> paths = analyse::smooth_paths(measured);
    for (const std::size_t i : mine) {
      auto& sample = recording.samples[i];
      for (const analyse::Path& path : paths) {
        const double at = (sample.time - path.start_s) / path.step_s;
        if (at < -0.5 || at > static_cast<double>(path.velocity.size()) - 0.5) continue;
        const auto nearest = static_cast<std::size_t>(std::max(0.0, std::round(at)));
        sample.velocity = path.velocity[std::min(nearest, path.velocity.size() - 1)];
      }
    }
  }
  return recording;
}

struct SharedWay {
  std::vector<analyse::TimedPlace> truth, track;
};

double length_of(const std::vector<analyse::TimedPlace>& way) {
  double length = 0;
  for (const analyse::Path& path : analyse::smooth_paths(way)) {
    for (std::size_t i = 1; i < path.place.size(); ++i) length += (path.place[i] - path.place[i - 1]).norm();
  }
  return length;
}

/// The ways of people and of their tracks, over the instants that both have; `times` are those of the truth's frames.
std::vector<PathLengths> way_lengths(const std::vector<evaluate::PersonPlace>& truth,
                                     const std::vector<evaluate::PersonPlace>& tracks,
                                     const std::vector<evaluate::PersonFate>& people, const std::map<std::int32_t, double>& times) {
  std::map<int, int> track_of;
  for (const evaluate::PersonFate& person : people) {
    if (person.track) track_of[person.id] = *person.track;
  }
  std::map<int, SharedWay> ways;
  std::size_t begin = 0;  // of the tracks' places in this frame
  for (const evaluate::PersonPlace& place : truth) {
    while (begin < tracks.size() && tracks[begin].frame < place.frame) ++begin;
    const auto track = track_of.find(place.id);
    if (track == track_of.end()) continue;
    std::size_t theirs = begin;
    while (theirs < tracks.size() && tracks[theirs].frame == place.frame && tracks[theirs].id != track->second) ++theirs;
    if (theirs == tracks.size() || tracks[theirs].frame != place.frame) continue;
    SharedWay& way = ways[place.id];
    const double time = times.at(place.frame);
    way.truth.push_back({time, place.place});
    way.track.push_back({time, tracks[theirs].place});
  }
  std::vector<PathLengths> lengths;
  for (const auto& [id, way] : ways) lengths.push_back({id, length_of(way.truth), length_of(way.track)});
  return lengths;
}

}  // namespace

MatchJudgement judge_match(const GroundRecording& truth, const GroundRecording& tracks, double farthest) {
  MatchJudgement judgement;
  const evaluate::InstantClock true_clock = evaluate::clock_of(truth), track_clock = evaluate::clock_of(tracks);
  const evaluate::InstantPairing pairing = evaluate::pair_instants(true_clock, track_clock);
  judgement.warnings = pairing.warnings;
  judgement.by_time = pairing.by_time;
  const auto moving = [](const GroundRecording& recording, const evaluate::InstantClock& clock) {
    const double period = clock.period.value_or(0);
    return has_velocities(recording) || (period > 0 && period <= kSlowest);
  };
  const auto prepared = [](const GroundRecording& recording, const evaluate::CommonNumbers& numbers) {
    return has_velocities(recording) ? evaluate::places_of(recording, numbers)
                                     : evaluate::places_of(with_velocities(recording), numbers);
  };
  const std::vector<evaluate::PersonPlace> true_places = prepared(truth, pairing.truth),
                                           track_places = prepared(tracks, pairing.tracks);
  judgement.evaluation = evaluate::evaluate_ground(true_places, track_places, farthest);
  judgement.has_speed = moving(truth, true_clock) && moving(tracks, track_clock);
  const double period = std::max(true_clock.period.value_or(0), track_clock.period.value_or(0));
  if (period > 0 && period <= kSlowest) {
    std::map<std::int32_t, double> times;
    for (const auto& instant : true_clock.instants) {
      if (const auto number = pairing.truth.find(instant.frame); number != pairing.truth.end())
        times[number->second] = instant.time;
    }
    judgement.ways = way_lengths(true_places, track_places, judgement.evaluation.people, times);
    double error = 0, length = 0;
    for (const PathLengths& way : judgement.ways) error += std::abs(way.track_m - way.true_m), length += way.true_m;
    if (length > 0) judgement.distance_error = error / length;
  }
  return judgement;
}

}  // namespace marey::pipeline
