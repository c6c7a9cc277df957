#include "marey/pipeline/people/ground/live_teams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "marey/draw/canvas.h"
#include "marey/geometry/median.h"

namespace marey::pipeline::people::ground {
namespace {

constexpr double kStepS = 0.2;  // between two instants that are kept; find_teams counts steps of up to 0.5 s as observed
constexpr double kKeptS = 60;
constexpr double kFindEveryS = 1;
constexpr double kCorrelated =
    8;  // neighbouring samples have correlated errors: this many count as one (track/ground/offline/ground_join.cpp)

/// The median of each component.
std::optional<Appearance> median_of(std::vector<Appearance>& samples) {
  if (samples.empty()) return std::nullopt;
  const auto median = [&](float Appearance::* component) {
    const auto less = [&](const Appearance& a, const Appearance& b) { return a.*component < b.*component; };
    return geometry::median(samples, less).*component;
  };
  double variance = 0;
  for (const Appearance& sample : samples) variance += static_cast<double>(sample.deviation) * sample.deviation;
  const auto count = static_cast<double>(samples.size());
  return Appearance{.lightness = median(&Appearance::lightness),
                    .a = median(&Appearance::a),
                    .b = median(&Appearance::b),
                    .deviation = static_cast<float>(std::sqrt(variance / count / std::max(1.0, count / kCorrelated)))};
}

std::array<std::uint8_t, 3> bytes_of(const Appearance& appearance) {
  const draw::Colour colour = draw::colour_of(appearance);
  return {static_cast<std::uint8_t>(colour.red), static_cast<std::uint8_t>(colour.green), static_cast<std::uint8_t>(colour.blue)};
}

}  // namespace

std::vector<TrackName> LiveTeams::step(const Instant& instant, const std::map<TrackId, Appearance>& appearances) {
  keep(instant, appearances);
  if (found_at_ && instant.time - *found_at_ < duration_from_seconds(kFindEveryS)) return {};
  found_at_ = instant.time;
  return find();
}

void LiveTeams::keep(const Instant& instant, const std::map<TrackId, Appearance>& appearances) {
  if (!kept_.empty() && instant.time - kept_.back().time < duration_from_seconds(kStepS)) return;
  TimeStep& time_step = kept_.emplace_back(TimeStep{instant.time, {}});
  for (const Sample& sample : instant.samples) {
    if (!sample.measured()) continue;
    const auto found = appearances.find(sample.track);
    time_step.people.push_back(
        {sample.track, sample.position.head<2>(), found == appearances.end() ? std::nullopt : std::optional(found->second)});
  }
  while (instant.time - kept_.front().time > duration_from_seconds(kKeptS)) kept_.pop_front();
}

std::vector<TrackName> LiveTeams::find() {
  std::map<TrackId, std::vector<Appearance>> observed;
  std::map<TrackId, TrackColumns> columns;
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  Recording recording(header);
  std::int32_t at = 0;
  for (const TimeStep& time_step : kept_) {
    recording.add_time_step({at, time_step.time});
    for (const Observed& person : time_step.people) {
      Sample sample;
      sample.track = person.track;
      sample.position.head<2>() = person.position;
      columns.try_emplace(person.track, TrackName{.id = person.track, .label = {}, .team = {}}, 2).first->second.add(at, sample);
      if (person.appearance) observed[person.track].push_back(*person.appearance);
    }
    ++at;
  }
  std::vector<std::optional<Appearance>> appearances;
  for (auto& [track, column] : columns) {
    appearances.push_back(median_of(observed[track]));
    recording.put(std::move(column));
  }
  const analyse::Teams found = analyse::find_teams(recording, appearances, options_);
  std::set<TrackId> present;
  for (const Observed& person : kept_.back().people) present.insert(person.track);
  std::vector<TrackName> changed;
  std::map<TrackId, std::string> teams;
  for (std::size_t i = 0; i < recording.tracks().size(); ++i) {
    const TrackId track = recording.tracks()[i].id();
    const std::optional<int> team = found.members[i].team;
    const auto before = teams_.find(track);
    // A team once found stays while nothing else is found: a person who is occluded keeps their team.
    if (!team) {
      if (before != teams_.end()) teams.insert(*before);
      continue;
    }
    const analyse::Teams::Team& one = found.teams[static_cast<std::size_t>(*team)];
    teams[track] = one.name;
    if (present.contains(track) && (before == teams_.end() || before->second != one.name))
      changed.push_back({track, {}, one.name, bytes_of(one.colour)});
    else if (before == teams_.end())
      teams.erase(track);
  }
  teams_ = std::move(teams);
  return changed;
}

}  // namespace marey::pipeline::people::ground
