#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/format/match/ground_match.h"

namespace marey::format::match {

/// Where a person belongs in the formats of matches, which know two teams.
enum class Side { home, away, referee, other, ball };

/// Where a ball is at one instant.
struct BallAt {
  Vector<3> location;                 ///< m
  std::optional<Vector<3>> velocity;  ///< m/s
};

/// Who is who in a file of a match.
struct LineUps {
  struct Member {
    Side side = Side::other;
    int number = 0;    ///< of the shirt, unique in the team: the label where it is one or begins with one, "7 Kane", else the id or
                       ///< what is free
    std::string name;  ///< the label, or "Player No.7"; never a bare number, which some readers choke on
  };
  std::array<std::string, 2> teams;   ///< names of home and away, "Home" and "Away" if the file has no names
  std::vector<Member> members;        ///< one a track, in the recording's order
  std::vector<std::size_t> listed;    ///< indices of the tracks in the match's order
  std::optional<std::size_t> ball;    ///< index of its track, where there is one
  std::vector<std::string> warnings;  ///< one sentence each

  std::vector<std::size_t> of(Side side) const;  ///< indices of its tracks, in the match's order
};

/// Indices of the recording's tracks in the match's order.
std::vector<std::size_t> listed_tracks(const GroundMatch& match);

/// Home and away are those that `match` names, else the two teams with the most places, in the order of their first people. Without
/// any team every person is at home. Throws Error if a named team has no person.
LineUps line_ups_of(const GroundMatch& match);

/// Where the ball is at each instant; nothing if it is not known.
std::vector<std::optional<BallAt>> ball_by_instant(const GroundMatch& match, const LineUps& line_ups);

/// The match's periods; one from the first frame to the last where it has none.
std::vector<GroundPeriod> periods_of(const GroundMatch& match);

/// Frames a second as a whole number, which some formats ask for. Throws Error, with the format's name, where the rate is more than
/// 0.5 % off, or above 1,000 Hz.
int whole_rate(double rate_hz, std::string_view format);

/// A path with its ending, from the last dot on, replaced.
std::string with_ending(const std::string& path, std::string_view ending);

}  // namespace marey::format::match
