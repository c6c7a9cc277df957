// Which of the poses in which it appears the same a body has: the part of BodyTracker that decides late.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/solve/bodies/body_tracker.h"

namespace marey::solve::bodies {
namespace {

constexpr double kProof = 25;         // log-likelihood ratio that turns a body
constexpr double kMaxAnInstant = 2;   // of that
constexpr double kTailFreedoms = 3;   // of how far a body is from where it is due
constexpr double kInQuestion = 0.02;  // from this probability on another pose is reported

double angle_between(const Matrix<3>& a, const Matrix<3>& b) {
  return geometry::angle_axis_of(a * b.transpose()).norm();
}

/// How likely it is to be so far from where it is due, but for a factor: Student's distribution about all three axes, for a
/// variance that was measured on other intervals says little of the rarest.
double likelihood(double angle, double variance) {
  return std::pow(1 + angle * angle / (kTailFreedoms * variance), -(kTailFreedoms + 3) / 2);
}

/// Which turn it is to be turned by `first`, then by `second`, counted from 1; 0: none.
std::size_t both(std::span<const Symmetry> turns, std::size_t first, std::size_t second) {
  if (first == 0 || second == 0) return first + second;
  const auto &a = turns[first - 1].onto, &b = turns[second - 1].onto;
  const auto is_both = [&](const Symmetry& turn) {
    for (std::size_t m = 0; m < a.size(); ++m) {
      if (turn.onto[m] != b[static_cast<std::size_t>(a[m])]) return false;
    }
    return true;
  };
  const auto found = std::find_if(turns.begin(), turns.end(), is_both);
  return found == turns.end() ? 0 : static_cast<std::size_t>(found - turns.begin()) + 1;
}

std::size_t inverse_of(std::span<const Symmetry> turns, std::size_t turn) {
  for (std::size_t other = 1; other <= turns.size(); ++other) {
    if (turn != 0 && both(turns, turn, other) == 0) return other;
  }
  return 0;
}

/// Of no turn, then of each: that the body is turned so against `rotation`.
std::vector<double> probabilities(std::span<const Symmetry> turns, const DueRotation& due, const Matrix<3>& rotation) {
  std::vector<double> of{likelihood(angle_between(due.rotation, rotation), due.variance)};
  for (const Symmetry& turn : turns)
    of.push_back(likelihood(angle_between(due.rotation, rotation * turn.body_from_body.rotation), due.variance));
  const double sum = std::accumulate(of.begin(), of.end(), 0.0);
  for (double& probability : of) probability /= sum;
  return of;
}

/// By turn, that the body is turned so against the pose that is `best` after the gap. What was in question before the gap
/// (`before`, by turn) still is: a turn from the pose then is one from the pose now.
std::vector<double> combined(std::span<const Symmetry> turns, std::span<const double> before, std::span<const double> after,
                             std::size_t best) {
  std::vector<double> result(turns.size() + 1);
  const std::size_t back_to_best = inverse_of(turns, best);
  for (std::size_t then = 0; then <= turns.size(); ++then) {
    const double was = then > 0 ? before[then - 1] : 1 - std::accumulate(before.begin(), before.end(), 0.0);
    for (std::size_t now = 0; now <= turns.size(); ++now)
      result[both(turns, then, both(turns, now, back_to_best))] += was * after[now];
  }
  result.erase(result.begin());
  return result;
}

}  // namespace

ObservedRotation BodyTracker::observed_rotation(int body, Timestamp now) const {
  const Tracked& one = tracked_[static_cast<std::size_t>(body)];
  ObservedRotation seen{.time = now, .rotation = one.fit->world_from_body.rotation, .rate = one.motion->turning_rate, .others = {}};
  for (const Tracked& other : tracked_) {
    const bool counts = &other != &one && other.measured;
    seen.others.push_back(counts ? std::optional(other.fit->world_from_body.rotation) : std::nullopt);
  }
  return seen;
}

/// Where a body that comes back is due at this instant: its turning rate now is not known yet.
Matrix<3> BodyTracker::due(int body) const {
  const Tracked& one = tracked_[static_cast<std::size_t>(body)];
  const ObservedRotation before = last_sure(one);
  ObservedRotation after{.time = *last_, .rotation = {}, .rate = before.rate, .others = {}};
  for (const Tracked& other : tracked_) {
    const bool counts = &other != &one && other.measured;
    after.others.push_back(counts ? std::optional(other.fit->world_from_body.rotation) : std::nullopt);
  }
  return one.hidden->due(before, after).rotation;
}

/// The symmetric pose that is turned the least from where the body was due.
Rigid3 BodyTracker::nearest_turn(const Tracked& one, Rigid3 pose, const Matrix<3>& due) const {
  Rigid3 best = pose;
  double minimum = angle_between(due, pose.rotation);
  for (const Symmetry& turn : one.rotations) {
    const Rigid3 rotated = pose * turn.body_from_body;
    const double angle = angle_between(due, rotated.rotation);
    if (angle < minimum) minimum = angle, best = rotated;
  }
  return best;
}

/// From now on the body is another of the poses in which it appears the same.
void BodyTracker::turn_body(int body, const Symmetry& turn) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  one.motion->world_from_body = one.motion->world_from_body * turn.body_from_body;
  one.fit->world_from_body = one.fit->world_from_body * turn.body_from_body;
  std::vector<int> point_of(one.point_of.size(), assign::kNoIndex);
  for (std::size_t m = 0; m < point_of.size(); ++m) point_of[m] = one.point_of[static_cast<std::size_t>(turn.onto[m])];
  one.point_of = std::move(point_of);
  one.hidden->interrupt();
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
    if (one.evidence[t] <= kProof) continue;
    turn_body(body, one.rotations[t]);
    std::fill(one.rotated.begin(), one.rotated.end(), 0.0);
    corrections_.push_back({.body = bodies_[static_cast<std::size_t>(body)].id,
                            .since = now,
                            .reported_from_body = one.rotations[t].body_from_body,
                            .other = {},
                            .ambiguity = 0,
                            .words = {}});
    return;
  }
}

/// The most probable of the other poses, where its markers do not exclude it.
std::optional<OtherPose> BodyTracker::other_of(const Tracked& one, const Rigid3& pose) const {
  std::optional<OtherPose> other;
  for (std::size_t t = 0; t < one.rotations.size(); ++t) {
    if (one.rotated[t] < kInQuestion || one.rotations[t].worst > noise_ || (other && one.rotated[t] <= other->probability))
      continue;
    other = OtherPose{.world_from_body = pose * one.rotations[t].body_from_body, .probability = one.rotated[t]};
  }
  return other;
}

/// Now that the turning rate is known after the gap too: how probable is each of the poses?
void BodyTracker::evaluate_return(int body, Timestamp now) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  if (!one.back) return;
  const int detected = ++one.back->detected;
  const double since_s = seconds(now - one.back->after.time);
  const bool settled = (detected >= kSettled && since_s >= kSettledS) || (detected >= kSlowlySettled && since_s >= kSlowlySettledS);
  if (!settled) return;
  Return back = *std::exchange(one.back, std::nullopt);
  const std::span<const Symmetry> turns = one.rotations;

  // By its own rates at both ends of the gap, or by what carries it, which may be seen only now.
  back.after.rate = one.motion->turning_rate;
  ObservedRotation seen = back.after;
  DueRotation due = one.hidden->due(back.before, back.after);
  const ObservedRotation seen_now = observed_rotation(body, now);
  if (const DueRotation later = one.hidden->due(back.before, seen_now); later.variance < due.variance) due = later, seen = seen_now;
  const std::vector<double> after = probabilities(turns, due, seen.rotation);
  const auto best = static_cast<std::size_t>(std::max_element(after.begin(), after.end()) - after.begin());
  const bool was_in_question = other_of(one, {}).has_value();
  one.rotated = combined(turns, one.rotated, after, best);

  Correction found{.body = bodies_[static_cast<std::size_t>(body)].id,
                   .since = back.after.time,
                   .reported_from_body = {},
                   .other = other_of(one, {}),
                   .ambiguity = 0,
                   .words = {}};
  const std::size_t back_to_best = inverse_of(turns, best);
  for (std::size_t turn = 0; turn <= turns.size(); ++turn) {
    const std::size_t against = both(turns, turn, back_to_best);
    if (against == 0 || turns[against - 1].worst > noise_ || after[turn] < kInQuestion || after[turn] <= found.ambiguity) continue;
    found.ambiguity = after[turn], found.words = words_of(turns[against - 1]);
  }
  counts_[static_cast<std::size_t>(body)].in_question += found.ambiguity > 0;
  if (best > 0) {
    found.reported_from_body = turns[best - 1].body_from_body;
    turn_body(body, turns[best - 1]);
  }
  if (best > 0 || found.other || was_in_question) corrections_.push_back(std::move(found));
}

}  // namespace marey::solve::bodies
