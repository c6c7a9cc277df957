// Drag is that of a football of 0.43 kg (k = ½ρ·c_d·A/m with c_d = 0.25), grass takes 0.8 m/s² from what rolls, a bounce keeps 0.6
// of the speed downwards and 0.85 of that along. A launch is found by shooting: flown, and corrected by the miss over the time.
#include "marey/simulate/match/match_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace marey::simulate::match {
namespace {

constexpr double kGravity = 9.81;       // m/s²
constexpr double kDrag = 0.0133;        // 1/m
constexpr double kGrass = 0.8;          // m/s², of what rolls
constexpr double kBounce = 0.6;         // of the speed downwards
constexpr double kAlong = 0.85;         // of the speed along, at a bounce
constexpr double kRolls = 0.8;          // m/s; what would bounce slower rolls
constexpr double kMaxControl = 14;      // m/s by which a holder's touch moves the ball
constexpr double kFetched = 6.5;        // s before the restart the ball is picked up,
constexpr double kLaid = 5;             // and laid down
constexpr double kBehindLines = 6;      // m behind the lines
constexpr double kBallStride = 0.7;     // s between touches of one who runs
constexpr double kShootingStep = 0.02;  // s
constexpr int kShots = 8;

/// `step` s later, in the air or over the grass.
void advance_ball(BallPosition& ball, double curl, double step) {
  Vector<3>& v = ball.velocity;
  const bool rolls = ball.location.z() <= kBallRadius + 1e-9 && std::abs(v.z()) < 1e-9;
  Vector<3> pull = -kDrag * v.norm() * v;
  const double along = v.head<2>().norm();
  if (rolls) {
    if (along > 0) pull.head<2>() -= std::min(kGrass, along / step) * v.head<2>() / along;
  } else {
    pull.z() -= kGravity;
    if (along > 1) pull.head<2>() += curl * Vector<2>(-v.y(), v.x()) / along;
  }
  v += step * pull;
  if (rolls) v.z() = 0;
  ball.location += step * v;
  if (ball.location.z() >= kBallRadius) return;
  ball.location.z() = 2 * kBallRadius - ball.location.z();
  v.z() *= -kBounce;
  v.head<2>() *= kAlong;
  if (v.z() > kRolls) return;
  ball.location.z() = kBallRadius;
  v.z() = 0;
}

}  // namespace

std::string_view to_string(BallState state) {
  constexpr std::array<std::string_view, 4> kNames{"held", "rolling", "flying", "dead"};
  return kNames[static_cast<std::size_t>(state)];
}

MatchBall::MatchBall(std::uint64_t seed, const geometry::PitchSize& pitch, const Vector<2>& begin) : pitch_(pitch), random_(seed) {
  now_.location.head<2>() = begin;
  before_ = now_;
}

/// To be at `to` after `seconds`, through the air by the chance `lofted`, and where it is in the air already.
void MatchBall::kick(const Vector<2>& to, double seconds, double lofted) {
  const bool flies = random_.chance(lofted) || now_.location.z() > kBallRadius + 0.1;
  curl_ = random_.gaussian(0, 1.2);
  const Vector<3> goal(to.x(), to.y(), kBallRadius);
  const BallPosition from = now_;
  Vector<3> launch = (goal - from.location) / seconds;
  launch.z() = flies ? launch.z() + 0.5 * kGravity * seconds : 0;
  const int steps = std::max(1, static_cast<int>(std::lround(seconds / kShootingStep)));
  for (int shot = 0; shot < kShots; ++shot) {
    BallPosition ball = from;
    ball.velocity = launch;
    if (!flies) ball.location.z() = kBallRadius;
    for (int i = 0; i < steps; ++i) advance_ball(ball, curl_, seconds / steps);
    launch.head<2>() += (goal - ball.location).head<2>() / seconds;
  }
  now_.velocity = launch;
  if (!flies) now_.location.z() = kBallRadius;
}

/// The holder's touch brings it before the feet, a little ahead at each stride.
void MatchBall::carry(double step, const MatchPosition& holder) {
  touch_ += step;
  const double speed = holder.velocity.norm();
  const double push = speed > 1.5 ? 0.35 * (1 - std::cos(2 * std::numbers::pi * touch_ / kBallStride)) / 2 : 0;
  const Vector<2> ahead = speed > 0.5 ? Vector<2>((0.38 + push) * holder.velocity / speed) : Vector<2>(0.3, 0.2);
  Vector<2> velocity = (holder.location + ahead - now_.location.head<2>()) / 0.12;
  if (velocity.norm() > kMaxControl) velocity *= kMaxControl / velocity.norm();
  now_.velocity.head<2>() = velocity + holder.velocity;
  if (now_.location.z() > kBallRadius) {
    now_.velocity.z() -= kGravity * step;
  } else {
    now_.velocity.z() = 0;
  }
  now_.location += step * now_.velocity;
  if (now_.location.z() < kBallRadius) now_.location.z() = kBallRadius, now_.velocity.z() = 0;
}

/// Some metres behind the line that a spot lies on.
Vector<2> MatchBall::beyond_line(const Vector<2>& spot) const {
  constexpr double kOut = 4;  // m
  if (spot.x() < 1) return spot - Vector<2>(kOut, 0);
  if (spot.x() > pitch_.length - 1) return spot + Vector<2>(kOut, 0);
  return spot + Vector<2>(0, spot.y() < pitch_.width / 2 ? -kOut : kOut);
}

void MatchBall::wait_outside(double step, const MatchPlay& play) {
  now_.there = play.phase_left() > kFetched || play.phase_left() < kLaid;
  if (play.phase_left() < kLaid) {
    now_.location = {play.ball().x(), play.ball().y(), kBallRadius};
    now_.velocity.setZero();
    return;
  }
  const Vector<3>& at = now_.location;
  const bool stopped = at.x() < -kBehindLines || at.y() < -kBehindLines || at.x() > pitch_.length + kBehindLines ||
                       at.y() > pitch_.width + kBehindLines;
  if (stopped) now_.velocity.head<2>().setZero();
  advance_ball(now_, curl_, step);
}

void MatchBall::step(double step, const MatchPlay& play, std::span<const MatchPosition, kMatchPeople> people) {
  before_ = now_;
  const MatchPlay::Phase last = std::exchange(phase_, play.phase());
  const bool is_new = last != phase_;
  now_.holder = phase_ == MatchPlay::Phase::held ? play.holder() : -1;
  now_.there = true;
  switch (phase_) {
    case MatchPlay::Phase::held:
      if (is_new) touch_ = 0;
      now_.state = BallState::held;
      carry(step, people[static_cast<std::size_t>(play.holder())]);
      return;
    case MatchPlay::Phase::flying:
      if (is_new) {
        const double far = (play.pass_target() - now_.location.head<2>()).norm();
        kick(play.pass_target(), std::max({0.2, play.phase_left(), far / 24}), far > 18 ? 0.6 : 0.25);
      }
      [[fallthrough]];
    case MatchPlay::Phase::loose:
      advance_ball(now_, curl_, step);
      now_.state = now_.location.z() > kBallRadius + 0.02 ? BallState::flying : BallState::rolling;
      return;
    case MatchPlay::Phase::stopped:
      now_.state = BallState::dead;
      if (is_new && play.phase_left() > kFetched) {
        const Vector<2> out = beyond_line(play.ball());
        kick(out, std::clamp((out - now_.location.head<2>()).norm() / 14, 0.8, 3.5), 0.5);
      }
      wait_outside(step, play);
  }
}

BallPosition MatchBall::at(double fraction) const {
  BallPosition location = now_;
  const bool carried_away = (now_.location - before_.location).norm() > 2;  // laid down elsewhere
  if (!carried_away) location.location = before_.location + fraction * (now_.location - before_.location);
  return location;
}

}  // namespace marey::simulate::match
