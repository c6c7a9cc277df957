// Who has the ball, the passes between people, and when it is out of play, from where the ball and every person is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/geometry/pitch.h"

namespace marey::analyse {

struct PossessionOptions {
  geometry::PitchSize pitch;
  double take_m = 1.2;   ///< a person who is nearest and so near to the ball takes it,
  double keep_m = 2;     ///< and has it until it is farther away than this, or another takes it
  double min_s = 0.2;    ///< for this long at least: a person the ball only passes has not had it
  double reach_m = 2.2;  ///< height above which no person has it
  double pass_m = 2;     ///< what goes less far is not a pass
};

/// One person has the ball.
struct BallSpell {
  int person = 0;  ///< id
  std::string team;
  double begin_s = 0, end_s = 0;
  Vector<2> from = Vector<2>::Zero(), to = Vector<2>::Zero();  ///< m: where the ball was
};

/// The ball goes from one person to another without having been out of play.
struct BallPass {
  int from = 0, to = 0;  ///< ids
  std::string team;      ///< of who passed
  double begin_s = 0, end_s = 0;
  double length_m = 0;
  bool completed = false;  ///< to the own team
};

struct TeamBall {
  std::string team;
  double possession_s = 0;  ///< in play, from the first touch of one of the team to the first of one of the other
  int passes = 0, completed = 0;
};

struct BallMeasure {
  double seconds = 0;             ///< the ball is known
  double dead_s = 0;              ///< of these it is off the pitch
  double distance_m = 0;          ///
  double top_mps = 0;             ///
  std::vector<BallSpell> spells;  ///< in order
  std::vector<BallPass> passes;   ///< in order
  std::vector<TeamBall> teams;    ///< by name
};

/// Nothing if the recording has no ball. People without a team, and referees, never have it. Throws Error for a recording that
/// is not of the ground in m.
std::optional<BallMeasure> measure_ball(const Recording& recording, const PossessionOptions& options = {});

}  // namespace marey::analyse
