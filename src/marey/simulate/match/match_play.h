// What each person on a football pitch wants to do at an instant: the ball is held, passed, lost, run after and out of play; each
// side keeps a formation that moves and breathes with it, closes the holder down and marks who runs; some stand and watch. It is no
// model of tactics: it makes people move, meet, run side by side, cross and stand as they do in a match. Cost: 25 people × 25 a
// step.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

inline constexpr int kMatchPeople = 25;   ///< 0–10 the home side, 11–21 the away side, 22 the referee, 23 and 24 the assistants
inline constexpr int kMatchPlayers = 22;  ///< of them
inline constexpr int kMatchSide = 11;     ///< players of a side; the first is its keeper

/// Where a person is and how it moves; m and m/s on the pitch.
struct MatchPosition {
  Vector<2> location = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
};

/// Where a person wants to be.
struct MatchIntent {
  Vector<2> target = Vector<2>::Zero();           ///< m
  Vector<2> target_velocity = Vector<2>::Zero();  ///< m/s: of the one it runs beside
  double speed = 0;                               ///< m/s at most; 0 to stand
};

class MatchPlay {
 public:
  MatchPlay(std::uint64_t seed, const geometry::PitchSize& pitch);

  /// Where all stand at the kick-off.
  std::array<Vector<2>, kMatchPeople> beginning();

  /// What each wants after `step` s more. Steps are short (some hundredths of a second).
  const std::array<MatchIntent, kMatchPeople>& decide(double step, std::span<const MatchPosition, kMatchPeople> people);

  /// m on the pitch.
  const Vector<2>& ball() const { return ball_; }

  enum class Phase { held, flying, loose, stopped };
  Phase phase() const { return phase_; }
  double phase_left() const { return phase_until_ - now_; }  ///< s, at least, but where the ball is loose
  int holder() const { return holder_; }                     ///< who has the ball, or had it last
  const Vector<2>& pass_target() const { return ball_to_; }  ///< m: where a ball that flies is to come down

 private:
  /// A sprint into space, and the opponent who goes with it.
  struct Run {
    int runner = 0, marker = 0;
    Vector<2> target;
    double until = 0, speed = 0;
  };
  struct Mind {
    double rethink_at = 0;  // s
    bool standing = true;
    Vector<2> wander = Vector<2>::Zero();  // m off the place of the role
    double pace = 1;                       // factor on speeds
  };
  using People = std::span<const MatchPosition, kMatchPeople>;

  void play_on(double step, People people);
  void end_hold(People people);
  void pass(People people);
  void stop_play();
  void take(int holder);
  void maybe_run(People people);
  Vector<2> role_position(int player) const;
  Vector<2> referee_position(int official, People people) const;
  void hold_role(int identity, const Vector<2>& target, double deadband, People people);
  void chase(People people);
  void mark(People people);
  int nearest(const Vector<2>& location, int side, People people) const;
  double along(int side, const Vector<2>& location) const;  // m from that side's own goal line
  Vector<2> from_goal(int side, double ahead, double aside) const;
  Vector<2> on_pitch(const Vector<2>& location, double margin) const;

  geometry::PitchSize pitch_;
  Random random_;
  double now_ = 0;
  Phase phase_ = Phase::stopped;
  double phase_until_ = 3;
  int holder_ = 9, receiver_ = 9;
  int attackers_ = 0;  // the side that has the ball, or had it last
  bool corner_ = false;
  Vector<2> ball_, ball_from_, ball_to_;
  double flight_begin_ = 0;
  double next_run_ = 5;
  std::optional<Run> run_;
  std::array<Mind, kMatchPeople> minds_{};
  std::array<MatchIntent, kMatchPeople> intents_{};
};

}  // namespace marey::simulate::match
