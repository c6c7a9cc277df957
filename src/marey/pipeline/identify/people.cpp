#include "marey/pipeline/identify/people.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/filter/human_motion.h"
#include "marey/track/ground/offline/ground_cut.h"

namespace marey::pipeline::identify {
namespace {

using format::match::clock_of_seconds;
using track::ground::offline::GroundSample;
using track::ground::offline::GroundTracklet;
using track::ground::offline::IdentityAnnotation;

constexpr double kLost = 1.5;                    // s without being measured, after which who is found may be another
constexpr double kPositionSigma = 0.15;          // m, of a place that was measured and smoothed
constexpr double kSpeedSigma = 0.8;              // m/s, by which one strays that was filled
constexpr double kOverlap = 5, kTogether = 1.5;  // s and m, of two tracks that show one person while one goes over into the other
constexpr std::size_t kMaxListed = 6;

/// Seconds from each row to the nearest one that was measured.
std::vector<double> unmeasured_for(const TrackColumns& track, std::span<const Timestamp> times) {
  std::vector<double> away(track.size(), 1e9);
  const auto time_of = [&](std::size_t row) { return seconds(times[static_cast<std::size_t>(track.at()[row])]); };
  double last = -1e9;
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (track.measured(row)) last = time_of(row);
    away[row] = time_of(row) - last;
  }
  double next = 1e9;
  for (std::size_t row = track.size(); row-- > 0;) {
    if (track.measured(row)) next = time_of(row);
    away[row] = std::min(away[row], next - time_of(row));
  }
  return away;
}

GroundSample sample_of(const TrackColumns& track, std::size_t row, double away) {
  const double sigma = kPositionSigma + kSpeedSigma * away;
  GroundSample sample;
  sample.instant = track.at()[row];
  sample.location = {static_cast<float>(track.x()[row]), static_cast<float>(track.y()[row])};
  sample.covariance = {static_cast<float>(sigma * sigma), 0, static_cast<float>(sigma * sigma)};
  // Cameras are omitted: two tracks of one person may both be reported by the same one while one goes over into the other.
  return sample;
}

/// The rows before which another person begins, because no person can have gone from the one before to it.
std::vector<bool> begins_another(const TrackColumns& track, std::span<const Timestamp> times) {
  std::vector<filter::TimedPosition> locations;
  std::vector<std::size_t> row_of;
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (!track.measured(row)) continue;
    const auto covariance = track.sample(row).covariance;
    locations.push_back(
        {seconds(times[static_cast<std::size_t>(track.at()[row])]), track.location(row),
         covariance ? Matrix<2>(covariance->topLeftCorner<2, 2>()) : kPositionSigma * kPositionSigma * Matrix<2>::Identity()});
    row_of.push_back(row);
  }
  std::vector<bool> begins(track.size(), false);
  for (const filter::ImpossiblePiece& piece : filter::impossible_pieces(locations)) {
    if (!piece.one_person) begins[row_of[piece.first + (piece.last - piece.first + 1) / 2]] = true;
  }
  return begins;
}

/// From a row that was measured to another one, without a gap that is long between, nor a leap that no person makes.
void add_tracklets(const TrackColumns& track, std::span<const Timestamp> times, std::vector<GroundTracklet>& tracklets) {
  const std::vector<bool> begins = begins_another(track, times);
  const std::vector<double> away = unmeasured_for(track, times);
  const auto time_of = [&](std::size_t row) { return times[static_cast<std::size_t>(track.at()[row])]; };
  std::optional<std::size_t> last;
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (!track.measured(row)) continue;
    if (!last || begins[row] || seconds(time_of(row) - time_of(*last)) > kLost) {
      if (last) tracklets.back().goes_on = true;
      tracklets.push_back({.runs = {{track.id(), 0}}, .confirmed = true, .samples = {}});
    } else {
      for (std::size_t between = *last + 1; between < row; ++between)
        tracklets.back().samples.push_back(sample_of(track, between, away[between]));
    }
    tracklets.back().samples.push_back(sample_of(track, row, 0));
    last = row;
  }
}

/// The two teams of most tracks.
std::map<std::string, int> team_numbers(const Recording& recording) {
  std::map<std::string, std::size_t> sizes;
  for (const TrackColumns& track : recording.tracks()) {
    if (!track.name.team.empty()) sizes[track.name.team] += track.size();
  }
  std::map<std::string, int> numbers;
  while (numbers.size() < 2 && !sizes.empty()) {
    const auto maximum =
        std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    numbers[maximum->first] = static_cast<int>(numbers.size());
    sizes.erase(maximum);
  }
  return numbers;
}

/// The instant that is nearest to a time.
std::int32_t instant_at(double time_s, const TrackedPeople& people) {
  const Timestamp time = timestamp_from_seconds(time_s);
  const auto after = std::lower_bound(people.times.begin(), people.times.end(), time);
  if (after == people.times.begin()) return 0;
  const auto before = std::prev(after);
  const bool later = after != people.times.end() && *after - time < time - *before;
  return static_cast<std::int32_t>((later ? after : before) - people.times.begin());
}

/// "#3, #7 and #9": the people there then, the nearest to where the track is nearest in time first.
std::string those_near_by(const Recording& recording, const TrackColumns* missing, std::int32_t instant) {
  std::vector<std::pair<double, int>> near;
  for (const TrackColumns& track : recording.tracks()) {
    const auto row = track.row_at(instant);
    if (!row || track.name.kind == TrackKind::ball) continue;
    double distance = number(track.id());
    if (missing != nullptr && !missing->empty()) {
      const bool later = instant > missing->at().back();
      distance = (track.location(*row) - missing->location(later ? missing->size() - 1 : 0)).norm();
    }
    near.emplace_back(distance, number(track.id()));
  }
  if (near.empty()) return "no person is there then";
  std::sort(near.begin(), near.end());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(kMaxListed, near.size()); ++i) names.push_back(fmt::format("#{}", near[i].second));
  return fmt::format("there are {}{}{}", fmt::join(names, ", "), near.size() > kMaxListed ? ", …" : "",
                     missing != nullptr ? ", the nearest first" : "");
}

[[noreturn]] void fail_not_there(const SquadNaming& naming, const SquadMember& member, const Recording& recording,
                                 std::int32_t instant) {
  const TrackColumns* track = recording.find(TrackId{naming.track});
  std::string when = "is not a track of the take";
  if (track != nullptr && !track->empty())
    when = fmt::format("is not there at {}, but from {} to {}", clock_of_seconds(naming.time_s),
                       clock_of_seconds(recording.seconds_at(static_cast<std::size_t>(track->at().front()))),
                       clock_of_seconds(recording.seconds_at(static_cast<std::size_t>(track->at().back()))));
  throw Error("{}: {} is to be #{}, which {}; {}", naming.where, member.label(), naming.track, when,
              those_near_by(recording, track, instant));
}

/// The tracklet of this track that holds the instant, or lies nearest to it.
int tracklet_at(const TrackedPeople& people, TrackId track, std::int32_t instant, const std::string& where) {
  int best = -1;
  std::int32_t nearest = 0;
  for (std::size_t i = 0; i < people.tracklets.size(); ++i) {
    const GroundTracklet& one = people.tracklets[i];
    if (one.runs.front().track != track) continue;
    const std::int32_t away = std::max({0, one.samples.front().instant - instant, instant - one.samples.back().instant});
    if (best >= 0 && away >= nearest) continue;
    best = static_cast<int>(i);
    nearest = away;
  }
  if (best < 0) throw Error("{}: #{} was never measured, and cannot be named", where, number(track));
  return best;
}

void require_on_pitch(const SquadNaming& naming, const SquadMember& member) {
  if (member.in_s && naming.time_s < *member.in_s)
    throw Error("{}: {} is named at {} and comes in at {}", naming.where, member.label(), clock_of_seconds(naming.time_s),
                clock_of_seconds(*member.in_s));
  if (member.out_s && naming.time_s > *member.out_s)
    throw Error("{}: {} is named at {} and has gone out at {}", naming.where, member.label(), clock_of_seconds(naming.time_s),
                clock_of_seconds(*member.out_s));
}

}  // namespace

TrackedPeople tracked_people(const Recording& recording) {
  TrackedPeople people;
  for (const Recording::TimeStep& time_step : recording.instants()) people.times.push_back(time_step.time);
  for (const TrackColumns& track : recording.tracks()) {
    if (track.name.kind != TrackKind::ball) add_tracklets(track, people.times, people.tracklets);
  }
  if (people.tracklets.empty()) throw Error("no person was measured in the take");
  track::ground::offline::GroundCutOptions cut;
  cut.overlap = kOverlap;
  cut.together = kTogether;
  people.tracklets = track::ground::offline::end_before_successors(std::move(people.tracklets), people.times, cut);
  const std::map<std::string, int> teams = team_numbers(recording);
  for (const GroundTracklet& tracklet : people.tracklets) {
    const auto team = teams.find(recording.find(tracklet.runs.front().track)->name.team);
    people.teams.push_back(team == teams.end() ? -1 : team->second);
  }
  return people;
}

std::vector<IdentityAnnotation> namings_of(std::span<const SquadNaming> given, const std::vector<SquadMember>& squads,
                                           const Recording& recording, const TrackedPeople& people) {
  std::vector<IdentityAnnotation> namings;
  for (const SquadNaming& naming : given) {
    const SquadMember& member = squads[static_cast<std::size_t>(naming.member)];
    require_on_pitch(naming, member);
    const std::int32_t instant = instant_at(naming.time_s, people);
    const TrackColumns* track = recording.find(TrackId{naming.track});
    if (track == nullptr || !track->row_at(instant)) fail_not_there(naming, member, recording, instant);
    const IdentityAnnotation now{tracklet_at(people, track->id(), instant, naming.where), instant, naming.member};
    for (std::size_t i = 0; i < namings.size(); ++i) {
      if (namings[i].instant != instant || (namings[i].name == now.name) == (given[i].track == naming.track)) continue;
      if (namings[i].name == now.name)
        throw Error("{}: {} is #{} here and, by {}, #{} at the same time", naming.where, member.label(), naming.track,
                    given[i].where, given[i].track);
      throw Error("{}: #{} is {} here and, by {}, {} at the same time", naming.where, naming.track, member.label(), given[i].where,
                  squads[static_cast<std::size_t>(namings[i].name)].label());
    }
    namings.push_back(now);
  }
  return namings;
}

}  // namespace marey::pipeline::identify
