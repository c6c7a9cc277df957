// The teams, learned from the recording itself: what each person wears over the whole of it (not frame by frame), the few
// colours that there are among them (colour_mixture.h), the two that most people wear. Others are keepers, who wear their own
// colour and stay near a goal, or referees. Every person's vote comes with its probability; an uncertain person stays without a
// team.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/recording.h"
#include "marey/geometry/pitch.h"

namespace marey::analyse {

/// A team as the user knows it.
struct TeamName {
  std::string name;
  Appearance colour;
};

/// "white,blue", or "City=sky blue,United=red": two, in the order in which teams are to be reported. Throws Error for what is not
/// so.
std::vector<TeamName> parse_teams(std::string_view text);

struct TeamOptions {
  std::vector<TeamName> names;               ///< none: teams are called by their colours
  double sure = 0.8;                         ///< who belongs to a team with less probability stays without
  double shortest = 0.8;                     ///< s; a person seen for less likewise
  std::optional<geometry::PitchSize> pitch;  ///< where goals are, for keepers; without it no keepers
};

struct Teams {
  enum class Role { unknown, player, keeper, referee };
  struct Team {
    std::string name;
    Appearance colour;  ///< deviation: how much its people differ
    int people = 0;
  };
  struct Member {
    Role role = Role::unknown;
    std::optional<int> team = {};  ///< index into `teams`
    double confidence = 0;         ///< probability of the answer, in [0, 1]
  };
  std::vector<Team> teams;      ///< two at most; as named, else the one most seen first
  std::vector<Member> members;  ///< one a track, in the recording's order
};

/// `wears` of each track of the recording, in their order, where known. `recording` is of the ground, in the pitch's frame where
/// `pitch` is given; throws Error for another.
Teams find_teams(const Recording& recording, std::span<const std::optional<Appearance>> clothing, const TeamOptions& options = {});

/// Writes the result into the recording: the team of players and keepers; "keeper" and "referee" as labels of those who have
/// none.
void note_teams(const Teams& teams, Recording& recording);

}  // namespace marey::analyse
