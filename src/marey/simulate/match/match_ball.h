// The ball of a simulated match in three dimensions: it goes where the play (match_play.h) sends it, by the physics of a ball. A
// pass rolls over the grass or flies, with gravity, drag of the air, a curl, and bounces; it is launched so that it is where the
// play wants it when the play wants it there. Its holder dribbles: it is touched ahead and run after. Out of play it flies over
// the line, is fetched, and lies where play continues. The play does not know of all that: people move as they do without it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/simulate/match/match_play.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

inline constexpr double kBallRadius = 0.11;  ///< m

enum class BallState {
  held,     ///< at a person's feet
  rolling,  ///
  flying,   ///< or bouncing
  dead,     ///< out of play, or waiting for the restart
};

/// "held", "rolling", …
std::string_view to_string(BallState state);

/// Where the ball is, in the pitch's frame with z up: its centre.
struct BallPosition {
  Vector<3> location = Vector<3>(0, 0, kBallRadius);  ///< m; 0.11 m up on the grass
  Vector<3> velocity = Vector<3>::Zero();             ///< m/s
  BallState state = BallState::dead;
  int holder = -1;    ///< who has it, 0 … kMatchPlayers − 1, where it is held
  bool there = true;  ///< else a person outside the images is fetching it
};

class MatchBall {
 public:
  MatchBall(std::uint64_t seed, const geometry::PitchSize& pitch, const Vector<2>& begin);

  /// What follows `play`'s decision for the next `step` s.
  void step(double step, const MatchPlay& play, std::span<const MatchPosition, kMatchPeople> people);

  /// At this share, in [0, 1], of the last step.
  BallPosition at(double fraction) const;

 private:
  void kick(const Vector<2>& to, double seconds, double lofted);
  void carry(double step, const MatchPosition& holder);
  void wait_outside(double step, const MatchPlay& play);
  Vector<2> beyond_line(const Vector<2>& spot) const;

  geometry::PitchSize pitch_;
  Random random_;
  MatchPlay::Phase phase_ = MatchPlay::Phase::stopped;
  double touch_ = 0;  // s since the holder took it
  double curl_ = 0;   // m/s² sideways while it flies
  BallPosition before_, now_;
};

}  // namespace marey::simulate::match
