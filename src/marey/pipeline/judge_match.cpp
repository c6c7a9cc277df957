// Judging tracks on the ground: which instants of the two recordings are the same, then the comparison place by place, then the
// ways' lengths. A recording's instants are its different frames; its period is the median time between two of them.
#include "marey/pipeline/judge_match.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/analyse/smooth_path.h"

namespace marey::pipeline {
namespace {

constexpr double kSlowest = 0.25;  // s between instants up to which a way between them is known
constexpr double kSame = 0.02;     // share by which periods may differ and still be one

struct Instant {
  std::int32_t frame = 0;
  double time = 0;
};

struct Clock {
  std::vector<Instant> instants;  // by frame
  double period = 0;              // s between instants; 0 where there are fewer than two
  double frame_s = 0;             // s a frame number
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

Clock clock_of(const GroundRecording& recording) {
  Clock clock;
  for (const auto& sample : recording.samples) {
    if (clock.instants.empty() || clock.instants.back().frame != sample.frame)
      clock.instants.push_back({sample.frame, sample.time});
  }
  std::vector<double> steps, per_frame;
  for (std::size_t i = 1; i < clock.instants.size(); ++i) {
    const Instant &before = clock.instants[i - 1], &now = clock.instants[i];
    steps.push_back(now.time - before.time);
    per_frame.push_back((now.time - before.time) / (now.frame - before.frame));
  }
  clock.period = median(std::move(steps));
  clock.frame_s = median(std::move(per_frame));
  return clock;
}

bool alike(double a, double b) {
  return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b));
}

/// Which of `others` is the same instant: index into it, or −1.
std::vector<std::ptrdiff_t> partners(const Clock& clock, const Clock& others, bool by_time) {
  std::vector<std::ptrdiff_t> result;
  const auto key = [by_time](const Instant& instant) { return by_time ? instant.time : static_cast<double>(instant.frame); };
  const double reach = by_time ? std::min(clock.period, others.period) / 2 + 1e-9 : 0;
  const auto begin = others.instants.begin(), end = others.instants.end();
  for (const Instant& instant : clock.instants) {
    auto next = std::lower_bound(begin, end, key(instant), [&](const Instant& a, double b) { return key(a) < b; });
    if (next != begin && (next == end || key(*next) - key(instant) > key(instant) - key(*(next - 1)))) --next;
    const bool near = next != end && std::abs(key(*next) - key(instant)) <= reach;
    result.push_back(near ? next - begin : -1);
  }
  return result;
}

/// The common number of each frame of a recording; frames that are not judged are in none.
using Numbers = std::map<std::int32_t, std::int32_t>;

struct Pairing {
  Numbers truth, tracks;
  bool by_time = false;
};

/// Numbers in the order of `leader`'s instants, given to `follower`'s partners too. Where `all`, the follower's instants that have
/// no partner get numbers of their own.
void number(const Clock& leader, const Clock& follower, bool by_time, bool all, Numbers& leading, Numbers& following) {
  const auto partner = partners(leader, follower, by_time);
  std::vector<bool> taken(follower.instants.size(), false);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < leader.instants.size(); ++i) {
    leading[leader.instants[i].frame] = next;
    if (partner[i] >= 0 && !taken[static_cast<std::size_t>(partner[i])]) {
      taken[static_cast<std::size_t>(partner[i])] = true;
      following[follower.instants[static_cast<std::size_t>(partner[i])].frame] = next;
    }
    ++next;
  }
  for (std::size_t i = 0; all && i < follower.instants.size(); ++i) {
    if (!taken[i]) following[follower.instants[i].frame] = next++;
  }
}

/// How much later the tracks' first common frame is than the truth's, s; 0 where there is none.
double time_between(const Clock& truth, const Clock& tracks) {
  const auto partner = partners(truth, tracks, false);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] >= 0) return tracks.instants[static_cast<std::size_t>(partner[i])].time - truth.instants[i].time;
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

std::vector<evaluate::PersonPlace> places_of(const GroundRecording& recording, const Numbers& numbers) {
  std::vector<evaluate::PersonPlace> places;
  places.reserve(recording.samples.size());
  auto number = numbers.end();
  std::int32_t last = -1;
  for (const auto& sample : recording.samples) {
    if (sample.frame != last || number == numbers.end()) number = numbers.find(sample.frame);
    last = sample.frame;
    if (number == numbers.end()) continue;
    places.push_back({number->second, recording.people[static_cast<std::size_t>(sample.person)].id, sample.place, sample.velocity});
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return places;
}

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
  const Clock true_clock = clock_of(truth), track_clock = clock_of(tracks);
  const Pairing pairing = pair_instants(true_clock, track_clock, judgement.warnings);
  judgement.by_time = pairing.by_time;
  const auto moving = [](const GroundRecording& recording, const Clock& clock) {
    return has_velocities(recording) || (clock.period > 0 && clock.period <= kSlowest);
  };
  const auto prepared = [](const GroundRecording& recording, const Numbers& numbers) {
    return has_velocities(recording) ? places_of(recording, numbers) : places_of(with_velocities(recording), numbers);
  };
  const std::vector<evaluate::PersonPlace> true_places = prepared(truth, pairing.truth),
                                           track_places = prepared(tracks, pairing.tracks);
  judgement.evaluation = evaluate::evaluate_ground(true_places, track_places, farthest);
  judgement.has_speed = moving(truth, true_clock) && moving(tracks, track_clock);
  const double period = std::max(true_clock.period, track_clock.period);
  if (period > 0 && period <= kSlowest) {
    std::map<std::int32_t, double> times;
    for (const Instant& instant : true_clock.instants) {
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
