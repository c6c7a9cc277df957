#include "marey/simulate/match/match_play.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::simulate::match {
namespace {

/// A role's place in its side's block: share of its length from the last line, share of its half width.
struct Role {
  double depth, aside;
};
using Formation = std::array<Role, 10>;
constexpr std::array<Formation, 2> kFormations{
    {{{{0, -0.8},
       {0, -0.27},
       {0, 0.27},
       {0, 0.8},
       {0.5, -0.85},
       {0.42, -0.25},
       {0.46, 0.25},
       {0.5, 0.85},
       {0.95, -0.2},
       {0.85, 0.25}}},
     {{{0.05, -0.8}, {0, -0.25}, {0, 0.25}, {0.05, 0.8}, {0.35, 0}, {0.5, -0.4}, {0.5, 0.4}, {0.9, -0.85}, {1, 0}, {0.9, 0.85}}}}};

constexpr double kBallSpeed = 15;       // m/s, of a pass
constexpr double kReach = 1.2;          // m; the ball is a player's within it
constexpr double kWanderTime = 9;       // s
constexpr double kWander = 2.4;         // m
constexpr double kDuelDistance = 0.55;  // m between two who fight for the ball
constexpr double kSprint = 9.5;         // m/s; as fast as possible
constexpr double kOutOfPlay = 0.15;     // of all times that a player gives the ball away
constexpr double kLost = 0.24;          // of all passes

int side_of(int player) {
  return player / kMatchSide;
}
bool is_keeper(int player) {
  return player % kMatchSide == 0;
}
const Role& role_of(int player) {
  return kFormations[static_cast<std::size_t>(side_of(player))][static_cast<std::size_t>(player % kMatchSide - 1)];
}
std::size_t index(int identity) {
  return static_cast<std::size_t>(identity);
}

}  // namespace

MatchPlay::MatchPlay(std::uint64_t seed, const geometry::PitchSize& pitch)
    : pitch_(pitch), random_(seed), ball_(pitch.length / 2, pitch.width / 2), ball_from_(ball_), ball_to_(ball_) {
  for (Mind& mind : minds_) {
    mind.pace = random_.uniform(0.9, 1.12);
    mind.wander = kWander * random_.gaussian_pair();
    mind.rethink_at = random_.uniform(0, 2);
  }
}

double MatchPlay::along(int side, const Vector<2>& location) const {
  return side == 0 ? location.x() : pitch_.length - location.x();
}

Vector<2> MatchPlay::from_goal(int side, double ahead, double aside) const {
  return side == 0 ? Vector<2>(ahead, pitch_.width / 2 + aside) : Vector<2>(pitch_.length - ahead, pitch_.width / 2 - aside);
}

Vector<2> MatchPlay::on_pitch(const Vector<2>& location, double margin) const {
  return {std::clamp(location.x(), margin, pitch_.length - margin), std::clamp(location.y(), margin, pitch_.width - margin)};
}

std::array<Vector<2>, kMatchPeople> MatchPlay::beginning() {
  std::array<Vector<2>, kMatchPeople> locations;
  for (int i = 0; i < kMatchPlayers; ++i) {
    if (is_keeper(i)) {
      locations[index(i)] = from_goal(side_of(i), 5, 0);
      continue;
    }
    const Role& role = role_of(i);
    const double half = pitch_.length / 2;
    locations[index(i)] = from_goal(side_of(i), (0.42 + 0.5 * role.depth) * half, role.aside * 0.42 * pitch_.width) +
                          random_.uniform_pair(-1, 1, -1, 1);
  }
  locations[index(holder_)] = ball_ + Vector<2>(-0.6, 0.3);
  locations[22] = ball_ + Vector<2>(-4, 9);
  locations[23] = {0.32 * pitch_.length, -1};
  locations[24] = {0.68 * pitch_.length, pitch_.width + 1};
  for (std::size_t i = 0; i < locations.size(); ++i) intents_[i].target = locations[i];
  return locations;
}

int MatchPlay::nearest(const Vector<2>& location, int side, People people) const {
  int best = side * kMatchSide + 1;
  double minimum = std::numeric_limits<double>::infinity();
  for (int i = side * kMatchSide + 1; i < (side + 1) * kMatchSide; ++i) {
    const double away = (people[index(i)].location - location).norm();
    if (away >= minimum) continue;
    minimum = away;
    best = i;
  }
  return best;
}

void MatchPlay::take(int holder) {
  phase_ = Phase::held;
  holder_ = holder;
  attackers_ = side_of(holder);
  corner_ = false;
  phase_until_ = now_ + (random_.chance(0.3) ? random_.uniform(2, 5) : random_.uniform(0.4, 1.8));
}

void MatchPlay::stop_play() {
  phase_ = Phase::stopped;
  attackers_ = 1 - attackers_;
  run_.reset();
  phase_until_ = now_ + random_.uniform(10, 35);
  corner_ = random_.chance(0.25);
  if (corner_) {
    attackers_ = ball_.x() > pitch_.length / 2 ? 0 : 1;
    const double flag = random_.chance(0.5) ? 0.5 : pitch_.width - 0.5;
    ball_ = {attackers_ == 0 ? pitch_.length - 0.5 : 0.5, flag};
    phase_until_ = now_ + random_.uniform(18, 30);
  } else {
    ball_.y() = ball_.y() < pitch_.width / 2 ? 0 : pitch_.width;
  }
  ball_to_ = ball_;
}

void MatchPlay::pass(People people) {
  // The nearer and the farther ahead, the likelier.
  const int side = side_of(holder_);
  std::array<double, kMatchPlayers> weights{};
  double sum = 0;
  for (int i = side * kMatchSide + 1; i < (side + 1) * kMatchSide; ++i) {
    const double away = (people[index(i)].location - ball_).norm();
    if (i == holder_ || away < 4) continue;
    const double ahead = along(side, people[index(i)].location) - along(side, ball_);
    sum += weights[index(i)] = std::exp(-away / 14 + ahead / 40) * (run_ && run_->runner == i ? 4 : 1);
  }
  double pick = random_.uniform(0, sum);
  receiver_ = holder_ == side * kMatchSide + 1 ? holder_ + 1 : side * kMatchSide + 1;
  for (int i = 0; i < kMatchPlayers; ++i) {
    if (weights[index(i)] == 0) continue;
    receiver_ = i;
    pick -= weights[index(i)];
    if (pick < 0) break;
  }
  const MatchPosition& to = people[index(receiver_)];
  const double flight = (to.location - ball_).norm() / kBallSpeed + 0.2;
  ball_from_ = ball_;
  ball_to_ = on_pitch(to.location + 0.8 * flight * to.velocity + 1.5 * random_.gaussian_pair(), 0.5);
  if (random_.chance(kLost))
    ball_to_ = on_pitch(0.4 * ball_to_ + 0.6 * people[index(nearest(ball_to_, 1 - side, people))].location, 0.5);
  phase_ = Phase::flying;
  flight_begin_ = now_;
  phase_until_ = now_ + flight;
}

void MatchPlay::end_hold(People people) {
  if (random_.chance(kOutOfPlay)) return stop_play();
  pass(people);
}

void MatchPlay::play_on(double step, People people) {
  const auto within_reach = [&](int player) { return (people[index(player)].location - ball_).norm() < kReach; };
  switch (phase_) {
    case Phase::held: {
      const MatchPosition& by = people[index(holder_)];
      const double speed = by.velocity.norm();
      const Vector<2> required = by.location + (speed > 0.5 ? Vector<2>(0.7 * by.velocity / speed) : Vector<2>(0.4, 0.2));
      ball_ += std::min(1.0, step / 0.2) * (required - ball_);
      if (now_ >= phase_until_) end_hold(people);
      return;
    }
    case Phase::flying: {
      const double done = std::min(1.0, (now_ - flight_begin_) / (phase_until_ - flight_begin_));
      ball_ = ball_from_ + done * (ball_to_ - ball_from_);
      if (done >= 1) phase_ = Phase::loose;
      return;
    }
    case Phase::loose: {
      const int side = random_.chance(0.5) ? 0 : 1;  // where both are there at once
      for (const int one : {side, 1 - side}) {
        const int closest = nearest(ball_, one, people);
        if (within_reach(closest)) return take(closest);
      }
      return;
    }
    case Phase::stopped: {
      const int taker = nearest(ball_, attackers_, people);
      if (now_ < phase_until_ || !within_reach(taker)) return;
      take(taker);
      phase_until_ = now_ + 0.4;
    }
  }
}

void MatchPlay::maybe_run(People people) {
  if (run_ && now_ > run_->until) run_.reset();
  if (run_ || now_ < next_run_ || phase_ == Phase::stopped) return;
  next_run_ = now_ + random_.uniform(3, 10);
  const int runner = attackers_ * kMatchSide + random_.integer(1, 10);
  if (runner == holder_) return;
  Run run;
  run.runner = runner;
  const double ahead = std::min(along(attackers_, people[index(runner)].location) + random_.uniform(15, 38), pitch_.length - 5);
  const Vector<2> location = people[index(runner)].location;
  run.target = on_pitch({from_goal(attackers_, ahead, 0).x(), location.y() + random_.uniform(-9, 9)}, 2);
  run.marker = nearest(location, 1 - attackers_, people);
  run.until = now_ + random_.uniform(2.5, 5);
  run.speed = random_.uniform(6.5, kSprint);
  run_ = run;
}

Vector<2> MatchPlay::role_position(int player) const {
  const int side = side_of(player);
  const double ball_ahead = along(side, ball_);
  const double ball_aside = (side == 0 ? 1 : -1) * (ball_.y() - pitch_.width / 2);
  const double scale = pitch_.length / 105;
  if (is_keeper(player)) return from_goal(side, 3 + 0.17 * ball_ahead, 0.15 * ball_aside) + 0.3 * minds_[index(player)].wander;
  const Role& role = role_of(player);
  const bool attacks = side == attackers_;
  const Vector<2>& wander = minds_[index(player)].wander;
  if (corner_) {  // crowded before the goal, one or two metres apart
    const bool stays = attacks ? role.depth < 0.1 && std::abs(role.aside) < 0.5 : role.depth > 0.92;
    if (!stays) return from_goal(attackers_, pitch_.length - 6 - 6 * role.depth, 9 * role.aside) + 0.5 * wander;
  }
  const double line = attacks ? std::clamp(0.58 * ball_ahead - 6 * scale, 14.0, 0.52 * pitch_.length)
                              : std::clamp(0.58 * ball_ahead - 14 * scale, 9.0, 0.45 * pitch_.length);
  const double length = scale * (attacks ? 40 : 31), half_width = pitch_.width * (attacks ? 0.44 : 0.32);
  const double aside = role.aside * half_width + (attacks ? 0.2 : 0.4) * ball_aside;
  return on_pitch(from_goal(side, line + role.depth * length, aside) + wander, 1);
}

Vector<2> MatchPlay::referee_position(int official, People people) const {
  if (official == 22) {  // some metres from the ball, on the diagonal that leaves the sides to the assistants
    const double turn = (ball_.x() / pitch_.length - 0.5) * 12;
    return on_pitch(ball_ + Vector<2>(ball_.x() > pitch_.length / 2 ? -9 : 9, 5 + turn) + minds_[22].wander, 3);
  }
  const int side = official == 23 ? 0 : 1;  // whose half it runs along: level with its last man but the keeper
  double last = pitch_.length / 2;
  for (int i = side * kMatchSide + 1; i < (side + 1) * kMatchSide; ++i)
    last = std::min(last, along(side, people[index(i)].location));
  return {from_goal(side, last, 0).x(), side == 0 ? -1.0 : pitch_.width + 1.0};
}

/// Thinks again now and then; stands while its place is near, else goes there the faster the farther it is.
void MatchPlay::hold_role(int identity, const Vector<2>& target, double deadband, People people) {
  Mind& mind = minds_[index(identity)];
  if (now_ < mind.rethink_at) return;
  mind.rethink_at = now_ + random_.uniform(0.4, 2.2);
  MatchIntent& intent = intents_[index(identity)];
  const double away = (target - people[index(identity)].location).norm();
  mind.standing = away < (mind.standing ? 1.5 : 0.5) * deadband;
  intent.target = target;
  intent.target_velocity.setZero();
  double speed = 6.2;
  if (away < 5)
    speed = 1.5;
  else if (away < 9)
    speed = 2.7;
  else if (away < 16)
    speed = 4.2;
  if (phase_ == Phase::stopped) speed = std::min(speed, corner_ ? 3.0 : 1.9);
  intent.speed = mind.standing ? 0 : speed * mind.pace;
}

/// Who has the ball, who is to get it, and who wants to take it away.
void MatchPlay::chase(People people) {
  const auto go = [&](int player, const Vector<2>& target, double speed) {
    intents_[index(player)] = {target, Vector<2>::Zero(), speed};
  };
  if (phase_ == Phase::stopped) {
    const int taker = nearest(ball_, attackers_, people);
    return go(taker, ball_, phase_until_ - now_ < 3 ? 4 : 2.2);
  }
  if (phase_ == Phase::flying) {
    go(receiver_, ball_to_, kSprint);
    go(nearest(ball_to_, 1 - side_of(receiver_), people), ball_to_, 6.5);
    return;
  }
  if (phase_ == Phase::loose) {
    for (const int side : {0, 1}) go(nearest(ball_, side, people), ball_, kSprint);
    return;
  }
  const MatchPosition& by = people[index(holder_)];
  const Vector<2> goal = from_goal(1 - attackers_, 8, 0);
  go(holder_, goal, 3.2 + 1.6 * (minds_[index(holder_)].pace - 0.9) / 0.2);
  const int presser = nearest(by.location, 1 - attackers_, people);
  const Vector<2> ahead = (goal - by.location).normalized();
  const double left = ahead.x() * (people[index(presser)].location - by.location).y() -
                      ahead.y() * (people[index(presser)].location - by.location).x();
  const Vector<2> aside = (left > 0 ? kDuelDistance : -kDuelDistance) * Vector<2>(-ahead.y(), ahead.x());
  intents_[index(presser)] = {by.location + aside + 0.2 * ahead, by.velocity, 7.5};
}

/// Who sprints, and who goes along, between the sprinter and the goal.
void MatchPlay::mark(People people) {
  if (!run_) return;
  intents_[index(run_->runner)] = {run_->target, Vector<2>::Zero(), run_->speed};
  const MatchPosition& runner = people[index(run_->runner)];
  const Vector<2> goal = from_goal(side_of(run_->marker), 0, 0);
  intents_[index(run_->marker)] = {runner.location + 0.8 * (goal - runner.location).normalized(), runner.velocity, kSprint};
}

const std::array<MatchIntent, kMatchPeople>& MatchPlay::decide(double step, People people) {
  now_ += step;
  const double fade = step / kWanderTime;
  for (Mind& mind : minds_) {
    mind.wander += -fade * mind.wander + kWander * std::sqrt(2 * fade) * random_.gaussian_pair();
  }
  play_on(step, people);
  maybe_run(people);
  for (int i = 0; i < kMatchPlayers; ++i) hold_role(i, role_position(i), is_keeper(i) ? 1.0 : 2.5, people);
  hold_role(22, referee_position(22, people), 4, people);
  for (const int assistant : {23, 24}) hold_role(assistant, referee_position(assistant, people), 1.5, people);
  mark(people);
  chase(people);
  return intents_;
}

}  // namespace marey::simulate::match
