#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/simulate/match/match_ball.h"
#include "marey/simulate/match/match_play.h"

namespace marey::simulate::match {

/// One person of a match at one instant, in the pitch's own frame: x along the touchline, y along the goal line, m.
struct MatchPerson {
  Vector<2> location = Vector<2>::Zero();  ///< m, below the hips
  Vector<2> velocity = Vector<2>::Zero();  ///< m/s: the exact derivative of `place`
  double heading = 0;                      ///< rad, anticlockwise from +x towards +y: where the body faces
  double phase = 0;                        ///< rad, of the gait (simulate/figure.h)
};

/// What person `index` (0 … kMatchPeople − 1) is called: the number on the shirt, or R, A1, A2; and the side: "white", "blue",
/// "referee".
std::string match_label(int index);
std::string_view match_team(int index);

/// 22 players and 3 referees of a football match: the same for the same seed, at whatever rate it is sampled.
///
/// They are stepped at a fixed 50 Hz; within a step each acceleration is constant, so that places and velocities are exact
/// at any time. Accelerations stay within what people have (the faster, the less), change smoothly, and keep bodies apart: the
/// speed at which two approach is held to what they can still brake. Memory does not grow with time.
class MatchMotion {
 public:
  /// `pitch` at least 40 × 25 m.
  explicit MatchMotion(std::uint64_t seed, const geometry::PitchSize& pitch = {});

  /// Goes to `time`, s since the kick-off, not negative. Times must not go back.
  void advance(double time);

  std::span<const MatchPerson, kMatchPeople> people() const { return now_; }
  Vector<2> ball() const { return play_.ball(); }  ///< to a step
  /// The ball itself, which rolls, flies and bounces to where the play has it.
  BallPosition ball_position() const { return ball_.at(fraction_); }

 private:
  struct Body {
    Vector<2> acceleration = Vector<2>::Zero();  // m/s², throughout the step
    Vector<2> effort = Vector<2>::Zero();        // m/s²: what it would be if no one else were there
    double ptz = 0, gait = 0;                    // rad/s
    double top_speed = 8;                        // m/s
  };
  using Velocities = std::array<Vector<2>, kMatchPeople>;

  void step();
  Vector<2> required_velocity(std::size_t i, const MatchIntent& intent) const;
  Vector<2> swerve(std::size_t i) const;
  void exert(std::size_t i, const Vector<2>& required);
  void keep_apart(Velocities& next) const;
  void turn(std::size_t i);

  MatchPlay play_;
  MatchBall ball_;
  double fraction_ = 0;  // of the step that is gone
  std::int64_t steps_ = 0;
  std::array<Body, kMatchPeople> bodies_{};
  std::array<MatchPerson, kMatchPeople> begin_{};  // at the beginning of the step
  std::array<MatchPerson, kMatchPeople> now_{};
};

}  // namespace marey::simulate::match
