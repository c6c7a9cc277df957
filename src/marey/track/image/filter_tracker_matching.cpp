// Which observation is which target's: gates, what a pair is worth, and what else is tried where that leaves a target without one.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "marey/track/image/filter_tracker.h"

namespace marey::track::image {
namespace {

constexpr double kReferenceSigma = 0.08;  // sizes: innovations of a well followed target
constexpr double kClutterRoom = 6;        // twice the log-likelihood ratio of a perfect fit against clutter
constexpr double kSizeRoom = 3;           // the same for its size
constexpr double kRecently = 0.35;        // s; a target seen since shows the camera's motion
constexpr double kCrowdedSizeLimit = 9;   // a box whose size is not trusted costs no more than this
constexpr double kStart = 1.0 / 9;        // of the highest speed: standard deviation of that of a target that was seen once
constexpr double kMaxSpread = 4;          // what the uncertainty of a target that was just seen costs, at most
constexpr double kReferenceStep = 0.2;    // s; what fades while a target is not seen was chosen on steps up to this
constexpr double kOverlap = 0.25;         // IoU of a target's box and what must be the target, there being no other

}  // namespace

/// Where the observation puts the target: the centre of its box, if need be corrected for a size that is not trusted.
Vector<2> FilterTracker::position_of(const Observation<2>& observation, const Target& target) const {
  return has_extent(observation) ? position_in(*observation.box, target, size_options_) : observation.value;
}

Matrix<2> FilterTracker::noise_of(const Observation<2>& observation, const Target& target) const {
  Matrix<2> R = *observation.covariance;
  if (!target.size || !observation.box) return R;
  if (options_.learn_noise) R.setZero();
  const bool trusted = !observation.shared && target.size->trusts(*observation.box, size_options_);
  const double sigma = options_.position_noise * target.unit * (trusted ? 1 : kUntrusted);
  R.diagonal() = R.diagonal().cwiseMax(Vector<2>::Constant(sigma * sigma));
  return R;
}

/// How far from its prediction a target may be: as far as it can have gone since it was last seen.
double FilterTracker::reach(const Target& target) const {
  const double since = seconds(*now_ - target.last_observed);
  return target.unit * (options_.max_speed * since + 4 * options_.position_noise);
}

/// No observation farther than this can pass the gate: a box whose size is not trusted may lie off by half a size more.
double FilterTracker::search_radius(const Target& target) const {
  return reach(target) + (target.size ? target.unit : 0.0);
}

/// How far from its prediction the target may be seen: as its filter has it. Of the speed of one that was seen once nothing can be
/// known, whatever its filter takes for certain (alpha-beta, extrapolation: rest).
Matrix<2> FilterTracker::innovation_of(const Target& target, const Matrix<2>& R) const {
  Matrix<2> S = target.filter.innovation_covariance(R);
  if (target.last_observed != target.initiated) return S;
  const double walked = kStart * options_.max_speed * target.unit * seconds(*now_ - target.last_observed);
  S.diagonal() = S.diagonal().cwiseMax((R.diagonal().array() + walked * walked).matrix());
  return S;
}

bool FilterTracker::was_observed_recently(const Target& target) const {
  return seconds(*now_ - target.last_observed) < std::max(kRecently, kNextFrame * dt_);
}

/// The part of its unseen time that counts against a target: where frames are far apart, nothing could have been observed between
/// them them.
double FilterTracker::missed_for(const Target& target) const {
  return seconds(*now_ - target.last_observed) - std::max(0.0, dt_ - kReferenceStep);
}

/// What the pair is worth: logarithm of its likelihood against that of clutter; 0 or less where it is out of the question.
double FilterTracker::gain(const Target& target, const Observation<2>& observation) const {
  const Matrix<2> R = noise_of(observation, target);
  const Matrix<2> S = innovation_of(target, R);
  const Vector<2> residual = position_of(observation, target) - target.filter.position();
  const double distance = residual.dot(S.inverse() * residual);
  if (!(distance <= gate_) || residual.norm() > reach(target)) return 0;
  double spread = std::log(S.determinant());
  if (!target.size || !observation.box) {
    // Nothing is known of how dense clutter is: the gate decides, and of two targets the one that is surer of its place wins.
    const double against_noise = std::clamp(spread - std::log(R.determinant()), 0.0, 2 * gate_);
    return (3 * gate_ - distance - against_noise) / 2;
  }
  spread -= 2 * 2 * std::log(target.unit * kReferenceSigma);
  const double missed = missed_for(target);
  // Frames far apart, or a filter that expects much, make the prediction wide; that alone does not make it another person.
  if (seconds(*now_ - target.last_observed) <= dt_) spread = std::min(spread, kMaxSpread);
  double cost = distance + spread;
  double room = kClutterRoom + clutter_.room() - 2 * missed / options_.fading;
  if (!observation.shared) {
    const double distance_of_size = target.size->distance(*observation.box, size_options_);
    cost += target.crowded ? std::min(distance_of_size, kCrowdedSizeLimit) : distance_of_size;
    room += kSizeRoom;
  }
  if (!target.confirmed()) cost += options_.evidence.newcomer_cost;
  return (room - cost) / 2;
}

/// Matches targets that have none with observations within their gates whose scores lie in [min_score, below_score).
void FilterTracker::match_gated(Detected detected, double min_score, double below_score) {
  candidates_.clear();
  points_.clear();
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (detected[i].score < min_score || detected[i].score >= below_score) continue;
    candidates_.push_back(i);
    points_.push_back(centre_of(detected[i]));
  }
  free_targets_.clear();
  double widest = 0;
  for (int i = 0; i < std::ssize(targets_); ++i) {
    if (targets_[i].observation) continue;
    free_targets_.push_back(i);
    widest += search_radius(targets_[i]);
  }
  if (candidates_.empty() || free_targets_.empty()) return;
  grid_.build(points_, std::max(1e-9, 2 * widest / static_cast<double>(free_targets_.size())));
  pairs_.clear();
  for (int row = 0; row < std::ssize(free_targets_); ++row) {
    const Target& target = targets_[free_targets_[row]];
    grid_.for_each_near(target.filter.position(), search_radius(target), [&](int column) {
      const double merit = gain(target, detected[candidates_[column]]);
      if (merit > 0) pairs_.push_back({row, column, merit});
    });
  }
  const auto columns = assigner_.assign(static_cast<int>(free_targets_.size()), static_cast<int>(candidates_.size()), pairs_);
  for (int row = 0; row < std::ssize(free_targets_); ++row) {
    if (columns[row] != assign::kNoIndex) targets_[free_targets_[row]].observation = candidates_[columns[row]];
  }
}

/// A target that turns sharply leaves the gate, yet not at once the place: a confirmed one without a match takes what lies on its
/// box and matches no other, before a new target begins there (after Cao et al., "Observation-centric SORT", 2023).
void FilterTracker::match_overlapping(Detected detected) {
  mark_taken(detected);
  candidates_.clear();
  points_.clear();
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (taken_[i] || !has_extent(detected[i]) || detected[i].score < options_.evidence.confident) continue;
    candidates_.push_back(i);
    points_.push_back(centre_of(detected[i]));
  }
  if (candidates_.empty() || crowd_.widest() <= 0) return;
  list_overlaps(detected);
  const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(candidates_.size()), pairs_);
  for (int row = 0; row < std::ssize(targets_); ++row) {
    if (columns[row] != assign::kNoIndex) targets_[row].observation = candidates_[columns[row]];
  }
}

/// Which candidates lie on the boxes of which targets without a match, into `pairs_`.
void FilterTracker::list_overlaps(Detected detected) {
  grid_.build(points_, crowd_.widest());
  pairs_.clear();
  for (int row = 0; row < std::ssize(targets_); ++row) {
    const Target& target = targets_[row];
    if (!target.confirmed() || target.observation || !target.size || !was_observed_recently(target)) continue;
    const Box box = target.size->around(target.filter.position());
    grid_.for_each_near(target.filter.position(), target.unit, [&](int column) {
      const double overlap = geometry::iou(box, *detected[candidates_[column]].box);
      if (overlap > kOverlap) pairs_.push_back({row, column, overlap});
    });
  }
}

void FilterTracker::match_reappeared(Detected detected) {
  if (!options_.reidentify) return;
  reidentification_.match(targets_, detected, *now_, {options_.evidence.confident, size_options_, gate_});
}

void FilterTracker::mark_taken(Detected detected) {
  taken_.assign(detected.size(), 0);
  for (const Target& target : targets_) {
    if (target.observation) taken_[*target.observation] = 1;
  }
}

}  // namespace marey::track::image
