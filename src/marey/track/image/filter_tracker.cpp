#include "marey/track/image/filter_tracker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "marey/geometry/chi_square.h"
#include "marey/track/check_frame.h"

namespace marey::track::image {
namespace {

constexpr double kLearnedStep = 0.03;  // s: at higher rates noise is learned from some of the frames, or trails would be too short
constexpr double kMissesASecond = 5;   // of evidence: neighbouring frames miss a target for the same reason
constexpr double kExpectedBack = 3;    // the same where a target that vanished is expected back
constexpr double kHiddenMiss = 0.1;    // evidence that a miss of a hidden target costs

/// What counts until more is known of the boxes.
BoxNoiseLevels first_levels(const TrackerOptions& options) {
  BoxNoiseLevels levels{.location = options.position_noise, .size = options.size_noise, .drift = options.size_drift};
  const auto* kalman = std::get_if<filter::KalmanOptions>(&options.filter);
  if (kalman != nullptr) levels.acceleration = kalman->acceleration_noise;
  return levels;
}

}  // namespace

FilterTracker::FilterTracker(const TrackerOptions& options)
    : options_(options),
      size_options_{.noise = options.size_noise, .drift = options.size_drift},
      gate_(geometry::chi_square_quantile(2, options.gate_probability)),
      first_(first_levels(options)),
      noise_(first_) {}

std::span<const Track<2>> FilterTracker::step(Timestamp now, std::span<const CameraObservations<2>> views) {
  assert(views.size() == 1 && "an image is one camera's");
  check_time(now, now_);
  check_finite(now, views.front().detected);
  predict_to(now);
  const Detected detected = in_scene(views.front().detected);
  crowd_.mark_crowded(targets_);
  match_gated(detected, options_.evidence.confident, std::numeric_limits<double>::infinity());
  match_gated(detected, options_.evidence.min_score, options_.evidence.confident);
  match_overlapping(detected);
  match_reappeared(detected);
  keep_merged(detected);
  correct(detected);
  learn_noise(detected);
  count_misses();
  retire_lost();
  start_unmatched(detected);
  return report();
}

std::span<const Track<2>> FilterTracker::expected(Timestamp now) {
  const double dt = std::max(0.0, seconds_to(now));
  const geometry::Similarity2 view_from_scene = scene_.view_from_scene(dt);
  tracks_.clear();
  for (const Target& target : targets_) {
    if (!target.confirmed()) continue;
    Target ahead = target;
    ahead.filter.predict(dt);
    ahead.shown.reset();
    tracks_.push_back(track_of(ahead, view_from_scene));
    tracks_.back().provenance = Provenance::predicted;
    tracks_.back().observation.reset();
  }
  return tracks_;
}

std::optional<BoxNoise> FilterTracker::learned_noise() const {
  return options_.learn_noise ? std::optional(noise_) : std::nullopt;
}

void FilterTracker::predict_to(Timestamp now) {
  dt_ = seconds_to(now);
  now_ = now;
  for (Target& target : targets_) {
    target.filter.predict(dt_);
    if (target.size) target.size->predict(dt_, size_options_);
    target.observation.reset();
    target.shown.reset();
    target.hidden = false;
  }
}

/// The observations, in coordinates that stand still while the camera pans, zooms and shakes: all that follows is in these.
FilterTracker::Detected FilterTracker::in_scene(Detected detected) {
  if (options_.stabilised_camera) return detected;
  expected_.clear();
  for (const Target& target : targets_) {
    if (!target.confirmed() || !target.size || !was_observed_recently(target)) continue;
    const double size = target.size->height(), noise = options_.position_noise * size;
    expected_.push_back({target.filter.position(), size, target.filter.covariance().trace() / 2 + noise * noise});
  }
  scene_.track_camera(dt_, expected_, detected, options_.evidence.confident);
  if (options_.learn_clutter) clutter_.observe_frame(scene_.sightings());
  return scene_.in_scene(detected);
}

/// How boxes err and how people move, from those seen in this frame.
void FilterTracker::learn_noise(Detected detected) {
  if (!options_.learn_noise) return;
  unlearned_ += dt_;
  if (unlearned_ < kLearnedStep) return;
  const double step = std::exchange(unlearned_, 0);
  for (Target& target : targets_) {
    const Observation<2>* one = target.observation ? &detected[*target.observation] : nullptr;
    target.trail.add(one != nullptr && has_extent(*one) ? *one->box : Box{});
    noise_.observe_frame(target.trail, step);
  }
  const BoxNoiseLevels levels = noise_.levels();
  options_.position_noise = levels.location;
  size_options_.noise = levels.size;
  size_options_.drift = levels.drift;
  noise_scale_ = levels.acceleration / first_.acceleration;
  lasting_ = lasting_fractions(noise_);
  for (Target& target : targets_) target.filter.scale_noise(noise_scale_);
}

/// A target that has merged with others stays within their region, keeps its size and waits for it to part; none begins there.
void FilterTracker::keep_merged(Detected detected) {
  merged_.assign(detected.size(), 0);
  crowd_.find_merged(targets_, detected, merged_,
                     [this](Target& target, const Observation<2>& region) { stay_within(target, region); });
}

void FilterTracker::stay_within(Target& target, const Observation<2>& region) const {
  const double sigma = kUntrusted * options_.position_noise * target.unit;
  const Matrix<2> R = *region.covariance + sigma * sigma * Matrix<2>::Identity();
  target.filter.correct(target.size->centre_within(*region.box, target.filter.position()), R);
  target.hidden = true;
}

void FilterTracker::correct(Detected detected) {
  for (Target& target : targets_) {
    if (target.observation) correct(target, detected[*target.observation], merged_[*target.observation] != 0);
  }
  crowd_.mark_hidden(targets_, detected);
}

void FilterTracker::correct(Target& target, const Observation<2>& observation, bool merged) const {
  if (merged) {
    stay_within(target, observation);
  } else {
    target.filter.correct(position_of(observation, target), noise_of(observation, target));
  }
  if (!merged && has_extent(observation) && !observation.shared && target.size) {
    target.size->correct(*observation.box, size_options_);
    target.unit = target.size->height();
    if (options_.learn_noise && target.size->trusts(*observation.box, size_options_))
      target.shown = written_box(target.size->around(target.filter.position()), *observation.box, lasting_);
  }
  if (options_.reidentify && observation.box) {
    const bool whole = !merged && !observation.shared && observation.score >= options_.evidence.confident;
    target.unoccluded_motion.observe_frame(*now_, dt_, target.filter.position(), target.filter.velocity(), observation.box->height,
                                           whole);
  }
  target.last_observed = *now_;
  target.score = observation.score;
  target.evidence.observe_frame(observation.score, options_.evidence);
}

void FilterTracker::count_misses() {
  const double miss = std::min(options_.evidence.miss, (options_.reidentify ? kExpectedBack : kMissesASecond) * dt_);
  for (Target& target : targets_) {
    if (!target.observation) target.evidence.miss(target.hidden ? kHiddenMiss : miss);
  }
}

void FilterTracker::retire_lost() {
  std::erase_if(targets_, [&](const Target& target) {
    const double unobserved = seconds(*now_ - target.last_observed);
    if (unobserved <= 0) return false;
    if (target.evidence.refuted()) return true;
    if (!target.confirmed()) return unobserved > std::max(options_.evidence.tentative_patience, kNextFrame * dt_);
    const double patience = target.hidden ? options_.hidden_patience : options_.patience;
    return unobserved > options_.evidence.patience(patience, seconds(target.last_observed - target.initiated));
  });
}

void FilterTracker::start_unmatched(Detected detected) {
  mark_taken(detected);
  points_.clear();
  double widest = 1e-9;
  for (const Observation<2>& one : detected) {
    points_.push_back(centre_of(one));
    if (one.box) widest = std::max(widest, one.box->height / 2);
  }
  grid_.build(points_, widest);
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (taken_[i] || merged_[i] || detected[i].score < options_.evidence.confident || is_duplicate(i, detected)) continue;
    start(detected[i], i);
    taken_[i] = 1;
  }
}

/// A detector's second box around what a target is matched with already. `grid_` holds the centres of all that was seen.
bool FilterTracker::is_duplicate(int index, Detected detected) const {
  bool found = false;
  if (!detected[index].box) return found;
  grid_.for_each_near(centre_of(detected[index]), detected[index].box->height / 2, [&](int other) {
    found = found || (taken_[other] && detected[other].box &&
                      geometry::iou(*detected[other].box, *detected[index].box) > options_.evidence.duplicate_iou);
  });
  return found;
}

void FilterTracker::start(const Observation<2>& observation, int index) {
  const bool has_box = has_extent(observation);
  const double unit = has_box ? observation.box->height : 1.0;
  Matrix<2> R = *observation.covariance;
  if (has_box) R.diagonal() = R.diagonal().cwiseMax(Vector<2>::Constant(std::pow(options_.position_noise * unit, 2)));
  Target& target = targets_.emplace_back(Target{.id = TrackId{next_id_++},
                                                .filter = {filter::scaled(options_.filter, unit), centre_of(observation), R},
                                                .size = {},
                                                .unit = unit,
                                                .initiated = *now_,
                                                .last_observed = *now_,
                                                .evidence = Evidence(observation.score, options_.evidence),
                                                .score = observation.score,
                                                .observation = index});
  target.filter.scale_noise(noise_scale_);
  if (has_box) target.size.emplace(*observation.box, size_options_);
}

Track<2> FilterTracker::track_of(const Target& target, const geometry::Similarity2& view_from_scene) {
  const Matrix<2>& turn = view_from_scene.turn;
  Track<2> track;
  track.id = target.id;
  track.position = view_from_scene * target.filter.position();
  track.velocity = turn * target.filter.velocity();
  track.covariance = turn * target.filter.covariance() * turn.transpose();
  track.provenance = target.observation ? Provenance::measured : Provenance::predicted;
  track.observation = target.observation;
  track.confirmed = target.confirmed();
  if (target.size) track.box = view_from_scene * target.shown.value_or(target.size->around(target.filter.position()));
  if (target.shown) track.position = track.box->centre();
  track.score = target.score;
  return track;
}

std::span<const Track<2>> FilterTracker::report() {
  tracks_.clear();
  for (const Target& target : targets_) tracks_.push_back(track_of(target, scene_.view_from_scene()));
  match_by_observation();
  return tracks_;
}

}  // namespace marey::track::image
