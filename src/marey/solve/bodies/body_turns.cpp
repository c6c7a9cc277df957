// Which of the poses in which it looks the same a body has: the part of BodyFollower that decides late.
#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/solve/bodies/body_follower.h"

namespace marey::solve::bodies {
namespace {

constexpr int kSettled = 8;           // instants until a turning rate is known again
constexpr double kSettledS = 0.04;    // s, at least
constexpr double kProof = 25;         // log-likelihood ratio that turns a body
constexpr double kMostAnInstant = 2;  // of that

Vector<3> rate_over(const Rigid3& from, const Rigid3& to) {
  return geometry::angle_axis_of(to.rotation * from.rotation.transpose());
}

}  // namespace

/// The symmetric pose that is turned the least from where the body was due.
Rigid3 BodyFollower::nearest_turn(const Followed& one, Rigid3 pose) const {
  Rigid3 best = pose;
  double least = rate_over(one.motion->world_from_body, pose).norm();
  for (const Symmetry& turn : one.turns) {
    const Rigid3 turned = pose * turn.body_from_body;
    const double angle = rate_over(one.motion->world_from_body, turned).norm();
    if (angle < least) least = angle, best = turned;
  }
  return best;
}

/// From `since` on the body is another of the poses in which it looks the same.
void BodyFollower::turn_body(int body, const Symmetry& turn, Timestamp since) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  one.motion->world_from_body = one.motion->world_from_body * turn.body_from_body;
  one.fit->world_from_body = one.fit->world_from_body * turn.body_from_body;
  std::vector<int> point_of(one.point_of.size(), assign::kNoIndex);
  for (std::size_t m = 0; m < point_of.size(); ++m) point_of[m] = one.point_of[static_cast<std::size_t>(turn.onto[m])];
  one.point_of = std::move(point_of);
  corrections_.push_back({bodies_[static_cast<std::size_t>(body)].id, since, turn.body_from_body});
  ++counts_[static_cast<std::size_t>(body)].corrected;
  std::fill(one.evidence.begin(), one.evidence.end(), 0.0);
}

/// Where a symmetry is not perfect, the markers themselves tell in the long run.
void BodyFollower::weigh_turns(int body, Timestamp now, std::span<const FollowedPoint> points) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  for (std::size_t t = 0; t < one.turns.size(); ++t) {
    if (one.turns[t].worst < noise_) continue;
    std::vector<Vector<3>> places, seen;
    for (std::size_t m = 0; m < one.places.size(); ++m) {
      const int point = one.point_of[static_cast<std::size_t>(one.turns[t].onto[m])];
      if (point < 0) continue;
      places.push_back(one.places[m]);
      seen.push_back(points[static_cast<std::size_t>(point)].position);
    }
    const auto other = fit_pose(places, seen, noise_);
    if (!other) continue;
    const double ratio = (one.fit->sum_of_squares - other->sum_of_squares) / (2 * noise_ * noise_);
    one.evidence[t] = std::max(one.evidence[t] + std::clamp(ratio, -kMostAnInstant, kMostAnInstant), 0.0);
    if (one.evidence[t] > kProof) return turn_body(body, one.turns[t], now);
  }
}

/// Now that the turning rate is known after the gap too: which of the poses is it that the mean of both rates leads to?
void BodyFollower::judge_return(int body, Timestamp now) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  if (!one.back || ++one.back->seen < kSettled || seconds(now - one.back->since) < kSettledS) return;
  const Return back = *std::exchange(one.back, std::nullopt);
  const double hidden = seconds(back.since - back.lost);
  Rigid3 due = back.before;
  due.rotation = geometry::rotation_from(hidden * (back.rate_before + one.motion->turning_rate) / 2) * due.rotation;
  double least = rate_over(due, back.after).norm();
  const Symmetry* best = nullptr;
  for (const Symmetry& turn : one.turns) {
    const double angle = rate_over(due, back.after * turn.body_from_body).norm();
    if (angle < 0.8 * least) least = angle, best = &turn;
  }
  if (best != nullptr) turn_body(body, *best, back.since);
}

}  // namespace marey::solve::bodies
