// Which of the poses in which it appears the same a body has: the part of BodyTracker that decides late.
#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/solve/bodies/body_follower.h"

namespace marey::solve::bodies {
namespace {

constexpr int kSettled = 8;          // instants until a turning rate is known again
constexpr double kSettledS = 0.04;   // s, at least
constexpr double kProof = 25;        // log-likelihood ratio that turns a body
constexpr double kMaxAnInstant = 2;  // of that

Vector<3> rate_over(const Rigid3& from, const Rigid3& to) {
  return geometry::angle_axis_of(to.rotation * from.rotation.transpose());
}

}  // namespace

/// The symmetric pose that is turned the least from where the body was due.
Rigid3 BodyTracker::nearest_turn(const Tracked& one, Rigid3 pose) const {
  Rigid3 best = pose;
  double minimum = rate_over(one.motion->world_from_body, pose).norm();
  for (const Symmetry& turn : one.rotations) {
    const Rigid3 rotated = pose * turn.body_from_body;
    const double angle = rate_over(one.motion->world_from_body, rotated).norm();
    if (angle < minimum) minimum = angle, best = rotated;
  }
  return best;
}

/// From `since` on the body is another of the poses in which it appears the same.
void BodyTracker::turn_body(int body, const Symmetry& turn, Timestamp since) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  one.motion->world_from_body = one.motion->world_from_body * turn.body_from_body;
  one.fit->world_from_body = one.fit->world_from_body * turn.body_from_body;
  std::vector<int> point_of(one.point_of.size(), assign::kNoIndex);
  for (std::size_t m = 0; m < point_of.size(); ++m) point_of[m] = one.point_of[static_cast<std::size_t>(turn.onto[m])];
  one.point_of = std::move(point_of);
  corrections_.push_back({bodies_[static_cast<std::size_t>(body)].id, since, turn.body_from_body});
  ++counts_[static_cast<std::size_t>(body)].corrected;
  std::fill(one.evidence.begin(), one.evidence.end(), 0.0);
}

/// Where a symmetry is not perfect, the markers themselves decide in the long run.
void BodyTracker::weigh_rotations(int body, Timestamp now, std::span<const BodyTrackPoint> points) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  for (std::size_t t = 0; t < one.rotations.size(); ++t) {
    if (one.rotations[t].worst < noise_) continue;
    std::vector<Vector<3>> locations, detected;
    for (std::size_t m = 0; m < one.locations.size(); ++m) {
      const int point = one.point_of[static_cast<std::size_t>(one.rotations[t].onto[m])];
      if (point < 0) continue;
      locations.push_back(one.locations[m]);
      detected.push_back(points[static_cast<std::size_t>(point)].position);
    }
    const auto other = fit_pose(locations, detected, noise_);
    if (!other) continue;
    const double ratio = (one.fit->sum_of_squares - other->sum_of_squares) / (2 * noise_ * noise_);
    one.evidence[t] = std::max(one.evidence[t] + std::clamp(ratio, -kMaxAnInstant, kMaxAnInstant), 0.0);
    if (one.evidence[t] > kProof) return turn_body(body, one.rotations[t], now);
  }
}

/// Now that the turning rate is known after the gap too: which of the poses is it that the mean of both rates leads to?
void BodyTracker::evaluate_return(int body, Timestamp now) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  if (!one.back || ++one.back->detected < kSettled || seconds(now - one.back->since) < kSettledS) return;
  const Return back = *std::exchange(one.back, std::nullopt);
  const double hidden = seconds(back.since - back.lost);
  Rigid3 due = back.before;
  due.rotation = geometry::rotation_from(hidden * (back.rate_before + one.motion->turning_rate) / 2) * due.rotation;
  double minimum = rate_over(due, back.after).norm();
  const Symmetry* best = nullptr;
  for (const Symmetry& turn : one.rotations) {
    const double angle = rate_over(due, back.after * turn.body_from_body).norm();
    if (angle < 0.8 * minimum) minimum = angle, best = &turn;
  }
  if (best != nullptr) turn_body(body, *best, back.since);
}

}  // namespace marey::solve::bodies
