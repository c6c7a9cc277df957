#include "marey/simulate/match/match_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "marey/simulate/people/figure.h"

namespace marey::simulate::match {
namespace {

constexpr double kStep = 0.02;        // s
constexpr double kResponse = 0.5;     // s that reaching a wanted velocity takes
constexpr double kEffortTime = 0.18;  // s that an effort takes to build up
constexpr double kMaxEffort = 5;      // m/s²
constexpr double kApproach = 2.0;     // m/s²; how people brake before a place they want to stand on
constexpr double kApart = 0.45;       // m between bodies
constexpr double kBrake = 8;          // m/s² that two have together, not to run into each other
constexpr double kForesight = 1.5;    // s that people use later frames for others ahead
constexpr double kPass = 0.8;         // m at which they like to pass each other
constexpr double kSwerve = 3.5;       // m/s² that they spend on it
constexpr int kRounds = 6;            // over all pairs that are too fast towards each other
constexpr double kCloseGap = 1.2;     // 1/s: how a gap to a person who is followed closes
constexpr double kPtz = 5;            // rad/s
constexpr double kStature = 1.79;     // m; decides the length of strides
constexpr double kWatchBelow = 0.6;   // m/s; slower people face the ball

Vector<2> clamped_to(const Vector<2>& value, double length) {
  const double norm = value.norm();
  return norm > length ? Vector<2>(value * (length / norm)) : value;
}

}  // namespace

std::string match_label(int index) {
  constexpr std::array<std::string_view, 3> kOfficials{"R", "A1", "A2"};
  if (index >= kMatchPlayers) return std::string(kOfficials[static_cast<std::size_t>(index - kMatchPlayers)]);
  return std::to_string(index % kMatchSide + 1);
}

std::string_view match_team(int index) {
  if (index >= kMatchPlayers) return "referee";
  return index < kMatchSide ? "white" : "blue";
}

MatchMotion::MatchMotion(std::uint64_t seed, const geometry::PitchSize& pitch)
    : play_(seed * 2654435761u + 11, pitch), ball_(seed * 2654435761u + 13, pitch, play_.ball()) {
  Random random(seed * 2654435761u + 12);
  const auto locations = play_.beginning();
  for (std::size_t i = 0; i < kMatchPeople; ++i) {
    begin_[i].location = locations[i];
    begin_[i].phase = random.uniform(0, 2 * std::numbers::pi);
    bodies_[i].top_speed = random.uniform(8.2, 9.4);
    const Vector<2> to_ball = play_.ball() - locations[i];
    begin_[i].heading = std::atan2(to_ball.y(), to_ball.x());
  }
  now_ = begin_;
  step();
  advance(0);
}

Vector<2> MatchMotion::required_velocity(std::size_t i, const MatchIntent& intent) const {
  if (intent.speed <= 0) return Vector<2>::Zero();
  const Vector<2> to_target = intent.target - begin_[i].location;
  const double top = std::min(intent.speed, bodies_[i].top_speed);
  if (intent.target_velocity.squaredNorm() > 0.25) return clamped_to(intent.target_velocity + kCloseGap * to_target, top);
  const double distance = to_target.norm();
  if (distance < 0.05) return Vector<2>::Zero();
  return to_target / distance * std::min(top, std::sqrt(2 * kApproach * distance));
}

/// Acceleration sideways, so as to pass others at some distance: both do their half, and where they meet head on both step to the
/// same hand.
Vector<2> MatchMotion::swerve(std::size_t i) const {
  Vector<2> sum = Vector<2>::Zero();
  for (std::size_t j = 0; j < kMatchPeople; ++j) {
    const Vector<2> between = begin_[j].location - begin_[i].location;
    const Vector<2> closing = begin_[i].velocity - begin_[j].velocity;
    const double approach = between.dot(closing);
    if (j == i || approach <= 0 || closing.squaredNorm() < 1) continue;
    const double when = approach / closing.squaredNorm();
    if (when > kForesight) continue;
    const Vector<2> miss = between - when * closing;
    if (miss.norm() >= kPass) continue;
    const Vector<2> hand(closing.y(), -closing.x());
    const Vector<2> sideways = miss.norm() > 0.1 ? Vector<2>(-miss / miss.norm()) : Vector<2>(hand / hand.norm());
    sum += std::min(kSwerve, (kPass - miss.norm()) / (when * when + 0.05)) * sideways;
  }
  return clamped_to(sum, kSwerve);
}

/// The effort goes towards what the wanted velocity asks for; forward, less is left the faster it is.
void MatchMotion::exert(std::size_t i, const Vector<2>& required) {
  const Vector<2>& velocity = begin_[i].velocity;
  Vector<2> requested = clamped_to((required - velocity) / kResponse + swerve(i), kMaxEffort);
  const double speed = velocity.norm();
  if (speed > 0.1) {
    const Vector<2> ahead = velocity / speed;
    const double forward = requested.dot(ahead);
    const double maximum = kMaxEffort * std::max(0.0, 1 - speed / bodies_[i].top_speed);
    if (forward > maximum) requested -= (forward - maximum) * ahead;
  }
  bodies_[i].effort += kStep / kEffortTime * (requested - bodies_[i].effort);
}

/// No one approaches another faster than both can brake within the distance between them.
void MatchMotion::keep_apart(Velocities& next) const {
  for (int round = 0; round < kRounds; ++round) {
    bool calm = true;
    for (std::size_t i = 0; i < kMatchPeople; ++i) {
      for (std::size_t j = i + 1; j < kMatchPeople; ++j) {
        const Vector<2> between = begin_[j].location - begin_[i].location;
        const double distance = between.norm();
        if (distance > 6 || distance < 1e-6) continue;
        const Vector<2> toward = between / distance;
        const double closing = (next[i] - next[j]).dot(toward);
        const double room = distance - kApart;
        const double allowed = room > 0 ? std::min(std::sqrt(2 * kBrake * room), 0.5 * room / kStep) : 4 * room;
        if (closing <= allowed) continue;
        calm = false;
        const Vector<2> push = 0.5 * (closing - allowed) * toward;
        next[i] -= push;
        next[j] += push;
      }
    }
    if (calm) return;
  }
}

/// People face where they go, and the ball while they stand.
void MatchMotion::turn(std::size_t i) {
  const MatchPerson& person = begin_[i];
  const double speed = person.velocity.norm();
  const Vector<2> face = speed > kWatchBelow ? person.velocity : Vector<2>(play_.ball() - person.location);
  const double off = std::remainder(std::atan2(face.y(), face.x()) - person.heading, 2 * std::numbers::pi);
  bodies_[i].ptz = std::clamp(off / 0.3, -kPtz, kPtz);
  bodies_[i].gait = 2 * std::numbers::pi * speed / people::stride_length(speed, kStature);
}

void MatchMotion::step() {
  std::array<MatchPosition, kMatchPeople> locations;
  for (std::size_t i = 0; i < kMatchPeople; ++i) locations[i] = {begin_[i].location, begin_[i].velocity};
  const auto& intents = play_.decide(kStep, locations);
  ball_.step(kStep, play_, locations);
  Velocities next;
  for (std::size_t i = 0; i < kMatchPeople; ++i) {
    exert(i, required_velocity(i, intents[i]));
    next[i] = begin_[i].velocity + kStep * bodies_[i].effort;
  }
  keep_apart(next);
  for (std::size_t i = 0; i < kMatchPeople; ++i) {
    bodies_[i].acceleration = (next[i] - begin_[i].velocity) / kStep;
    bodies_[i].effort = clamped_to(bodies_[i].acceleration, kMaxEffort);
    turn(i);
  }
}

void MatchMotion::advance(double time) {
  const auto after = [this](double seconds) {
    for (std::size_t i = 0; i < kMatchPeople; ++i) {
      const Body& body = bodies_[i];
      now_[i] = begin_[i];
      now_[i].location += seconds * begin_[i].velocity + 0.5 * seconds * seconds * body.acceleration;
      now_[i].velocity += seconds * body.acceleration;
      now_[i].heading += seconds * body.ptz;
      now_[i].phase += seconds * body.gait;
    }
  };
  assert(time >= static_cast<double>(steps_) * kStep && "time goes forwards");
  while (static_cast<double>(steps_ + 1) * kStep <= time) {
    after(kStep);
    begin_ = now_;
    ++steps_;
    step();
  }
  const double rest = time - static_cast<double>(steps_) * kStep;
  fraction_ = rest / kStep;
  after(rest);
}

}  // namespace marey::simulate::match
