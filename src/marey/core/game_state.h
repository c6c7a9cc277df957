#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// The role of a person on a pitch, as SoccerNet's game state divides people.
enum class PitchRole : std::uint8_t { player, goalkeeper, referee, other };

/// Whose half is whose: the team that defends the left goal, the right one, none, or the text "nan".
enum class PitchTeam : std::uint8_t { none, left, right, nan };

/// One person of one image of a game state.
struct PitchPerson {
  std::int32_t frame = 0;                  ///< the image's number, from 0
  std::int32_t id = 0;                     ///< of the track
  Vector<2> location = Vector<2>::Zero();  ///< m from the centre spot
  PitchRole role = PitchRole::player;
  PitchTeam team = PitchTeam::none;  ///< none unless a player or a goalkeeper
  std::string jersey;                ///< as the file writes it; "" where it is not known; only of players
};

/// The people of one clip.
struct GameState {
  std::vector<PitchPerson> people;    ///< ordered by frame; an id stands once a frame
  std::vector<std::string> warnings;  ///< one sentence each
};

}  // namespace marey
