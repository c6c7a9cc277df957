// Teams while people are tracked live: the data of the last minute are given to analyse::find_teams once per second. Only with
// teams that the user named, for a team named by its colour could change its name from second to second. Cost: 300 instants of
// each person, about a millisecond per second.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/teams.h"
#include "marey/core/instant.h"

namespace marey::pipeline::people::ground {

class LiveTeams {
 public:
  /// `options.pitch` as in find_teams; positions are in its frame.
  explicit LiveTeams(analyse::TeamOptions options) : options_(std::move(options)) {}

  /// `appearances`: what was observed at this instant, by track. Returns the tracks whose team is new or another than before, with
  /// the team's colour.
  std::vector<TrackName> step(const Instant& instant, const std::map<TrackId, Appearance>& appearances);

 private:
  struct Observed {
    TrackId track{};
    Vector<2> position = Vector<2>::Zero();
    std::optional<Appearance> appearance;
  };
  struct TimeStep {
    Timestamp time{};
    std::vector<Observed> people;
  };

  void keep(const Instant& instant, const std::map<TrackId, Appearance>& appearances);
  std::vector<TrackName> find();

  analyse::TeamOptions options_;
  std::deque<TimeStep> kept_;
  std::optional<Timestamp> found_at_;
  std::map<TrackId, std::string> teams_;
};

}  // namespace marey::pipeline::people::ground
