#include "marey/track/filter_tracker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "marey/geometry/chi_square.h"
#include "marey/track/check_frame.h"

namespace marey::track {
namespace {

constexpr double kUnbelieved = 2.5;       // a box that is not believed places its target this much less surely
constexpr double kReferenceSigma = 0.08;  // sizes: innovations of a well followed target
constexpr double kClutterRoom = 6;        // twice the log-likelihood ratio of a perfect fit against clutter
constexpr double kSizeRoom = 3;           // the same for its size
constexpr double kRecently = 0.35;        // s; a target seen since shows the camera's motion
constexpr double kCrowdedSizeLimit = 9;   // a box whose size is not believed costs no more than this
constexpr double kMissesASecond = 5;      // of evidence: neighbouring frames miss a target for the same reason
constexpr double kExpectedBack = 3;       // the same where a target that vanished is expected back
constexpr double kHiddenMiss = 0.1;       // evidence that a miss of a hidden target costs
constexpr double kStart = 1.0 / 9;        // of the highest speed: standard deviation of that of a target that was seen once
constexpr double kMostSpread = 4;         // what the uncertainty of a target that was just seen costs, at most
constexpr double kUsualStep = 0.2;        // s; what fades while a target is not seen was chosen on steps up to this
constexpr double kNextFrame = 1.5;        // steps: a target may be missing from one frame
constexpr double kOverlap = 0.25;         // IoU of a target's box and what must be the target, there being no other

Vector<2> centre_of(const Observation<2>& observation) {
  return observation.box ? observation.box->centre() : observation.value;
}

bool has_extent(const Observation<2>& observation) {
  return observation.box && !observation.box->empty();
}

/// What counts until more is known of the boxes.
BoxNoiseLevels first_levels(const TrackerOptions& options) {
  BoxNoiseLevels levels{.place = options.place_noise, .size = options.size_noise, .drift = options.size_drift};
  const auto* kalman = std::get_if<filter::KalmanOptions>(&options.filter);
  if (kalman != nullptr) levels.acceleration = kalman->acceleration_noise;
  return levels;
}

/// How much of an error is there in the next frame too: the pose of the person, or a habit of the detector.
double share_that_lasts(double of_a_frame, double in_all) {
  return std::max(0.0, 1 - of_a_frame * of_a_frame / (in_all * in_all));
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
  check_finite(now, views.front().seen);
  predict_to(now);
  const Seen seen = in_scene(views.front().seen);
  crowd_.mark_crowded(targets_);
  match_gated(seen, options_.evidence.confident, std::numeric_limits<double>::infinity());
  match_gated(seen, options_.evidence.least_score, options_.evidence.confident);
  match_overlapping(seen);
  match_reappeared(seen);
  keep_merged(seen);
  correct(seen);
  learn_noise(seen);
  count_misses();
  retire_lost();
  start_unmatched(seen);
  return report();
}

std::span<const Track<2>> FilterTracker::expected(Timestamp now) {
  const double dt = std::max(0.0, seconds_to(now));
  tracks_.clear();
  for (const Target& target : targets_) {
    if (!target.confirmed()) continue;
    Target ahead = target;
    ahead.filter.predict(dt);
    ahead.shown.reset();
    tracks_.push_back(track_of(ahead));
    tracks_.back().state = Track<2>::State::predicted;
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

/// What was seen, in coordinates that stand still while the camera pans, zooms and shakes: all that follows is in these.
FilterTracker::Seen FilterTracker::in_scene(Seen seen) {
  if (options_.steady_camera) return seen;
  follow_camera(seen);
  const geometry::Similarity2 scene_from_view = camera_.view_from_scene().inverse();
  const double scale = scene_from_view.scale();
  scene_seen_.assign(seen.begin(), seen.end());
  for (Observation<2>& one : scene_seen_) {
    one.value = scene_from_view * one.value;
    one.covariance *= scale * scale;
    if (one.box) one.box = scene_from_view * *one.box;
  }
  return scene_seen_;
}

void FilterTracker::follow_camera(Seen seen) {
  camera_.predict(dt_);
  expected_.clear();
  sightings_.clear();
  const geometry::Similarity2& view_from_scene = camera_.view_from_scene();
  const double scale = view_from_scene.scale();
  for (const Target& target : targets_) {
    if (!target.confirmed() || !target.size || !was_seen_recently(target)) continue;
    const double size = target.size->height();
    const double noise = options_.place_noise * size;
    const double variance = target.filter.covariance().trace() / 2 + noise * noise;
    expected_.push_back({view_from_scene * target.filter.position(), scale * size, scale * scale * variance});
  }
  for (const Observation<2>& one : seen) {
    if (has_extent(one) && one.score >= options_.evidence.confident) sightings_.push_back({one.box->centre(), one.box->height});
  }
  camera_.correct(expected_, sightings_);
  if (options_.learn_clutter) clutter_.see(sightings_);
}

/// How boxes err and how people move, from those seen in this frame.
void FilterTracker::learn_noise(Seen seen) {
  if (!options_.learn_noise) return;
  for (Target& target : targets_) {
    const Observation<2>* one = target.observation ? &seen[*target.observation] : nullptr;
    target.trail.add(one != nullptr && has_extent(*one) ? *one->box : Box{});
    noise_.see(target.trail, dt_);
  }
  const BoxNoiseLevels levels = noise_.levels(), frame = noise_.levels_of_a_frame();
  options_.place_noise = levels.place;
  size_options_.noise = levels.size;
  size_options_.drift = levels.drift;
  noise_scale_ = levels.acceleration / first_.acceleration;
  believed_place_ = share_that_lasts(frame.place, levels.place);
  believed_size_ = share_that_lasts(frame.size, levels.size);
  for (Target& target : targets_) target.filter.scale_noise(noise_scale_);
}

/// Where the observation puts the target: the centre of its box, if need be corrected for a size that is not believed.
Vector<2> FilterTracker::place_of(const Observation<2>& observation, const Target& target) const {
  return has_extent(observation) ? place_in(*observation.box, target, size_options_) : observation.value;
}

Matrix<2> FilterTracker::noise_of(const Observation<2>& observation, const Target& target) const {
  Matrix<2> R = observation.covariance;
  if (!target.size || !observation.box) return R;
  if (options_.learn_noise) R.setZero();
  const bool believed = !observation.shared && target.size->believes(*observation.box, size_options_);
  const double sigma = options_.place_noise * target.unit * (believed ? 1 : kUnbelieved);
  R.diagonal() = R.diagonal().cwiseMax(Vector<2>::Constant(sigma * sigma));
  return R;
}

/// How far from its prediction a target may be: as far as it can have gone since it was last seen.
double FilterTracker::reach(const Target& target) const {
  const double since = seconds(*now_ - target.last_seen);
  return target.unit * (options_.max_speed * since + 4 * options_.place_noise);
}

/// No observation farther than this can pass the gate: a box whose size is not believed may lie off by half a size more.
double FilterTracker::search_radius(const Target& target) const {
  return reach(target) + (target.size ? target.unit : 0.0);
}

/// How far from its prediction the target may be seen: as its filter has it. Of the speed of one that was seen once nothing can be
/// known, whatever its filter takes for certain (alpha-beta, extrapolation: rest).
Matrix<2> FilterTracker::innovation_of(const Target& target, const Matrix<2>& R) const {
  Matrix<2> S = target.filter.innovation_covariance(R);
  if (target.last_seen != target.born) return S;
  const double walked = kStart * options_.max_speed * target.unit * seconds(*now_ - target.last_seen);
  S.diagonal() = S.diagonal().cwiseMax((R.diagonal().array() + walked * walked).matrix());
  return S;
}

bool FilterTracker::was_seen_recently(const Target& target) const {
  return seconds(*now_ - target.last_seen) < std::max(kRecently, kNextFrame * dt_);
}

/// The part of its unseen time that tells against a target: where frames are far apart, nobody could have been seen between them.
double FilterTracker::missed_for(const Target& target) const {
  return seconds(*now_ - target.last_seen) - std::max(0.0, dt_ - kUsualStep);
}

/// What the pair is worth: logarithm of its likelihood against that of clutter; 0 or less where it is out of the question.
double FilterTracker::gain(const Target& target, const Observation<2>& observation) const {
  const Matrix<2> R = noise_of(observation, target);
  const Matrix<2> S = innovation_of(target, R);
  const Vector<2> residual = place_of(observation, target) - target.filter.position();
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
  // Frames far apart, or a filter that expects much, make the prediction wide; that alone makes nobody somebody else.
  if (seconds(*now_ - target.last_seen) <= dt_) spread = std::min(spread, kMostSpread);
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

/// Matches targets that have none with observations within their gates whose scores lie in [least_score, below_score).
void FilterTracker::match_gated(Seen seen, double least_score, double below_score) {
  candidates_.clear();
  points_.clear();
  for (int i = 0; i < std::ssize(seen); ++i) {
    if (seen[i].score < least_score || seen[i].score >= below_score) continue;
    candidates_.push_back(i);
    points_.push_back(centre_of(seen[i]));
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
      const double worth = gain(target, seen[candidates_[column]]);
      if (worth > 0) pairs_.push_back({row, column, worth});
    });
  }
  const auto columns = assigner_.assign(static_cast<int>(free_targets_.size()), static_cast<int>(candidates_.size()), pairs_);
  for (int row = 0; row < std::ssize(free_targets_); ++row) {
    if (columns[row] != assign::kNoIndex) targets_[free_targets_[row]].observation = candidates_[columns[row]];
  }
}

/// A target that turns sharply leaves the gate, yet not at once the place: a confirmed one without a match takes what lies on its
/// box and matches no other, before a new target begins there (after Cao et al., "Observation-centric SORT", 2023).
void FilterTracker::match_overlapping(Seen seen) {
  mark_taken(seen);
  candidates_.clear();
  points_.clear();
  for (int i = 0; i < std::ssize(seen); ++i) {
    if (taken_[i] || !has_extent(seen[i]) || seen[i].score < options_.evidence.confident) continue;
    candidates_.push_back(i);
    points_.push_back(centre_of(seen[i]));
  }
  if (candidates_.empty() || crowd_.widest() <= 0) return;
  list_overlaps(seen);
  const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(candidates_.size()), pairs_);
  for (int row = 0; row < std::ssize(targets_); ++row) {
    if (columns[row] != assign::kNoIndex) targets_[row].observation = candidates_[columns[row]];
  }
}

/// Which candidates lie on the boxes of which targets without a match, into `pairs_`.
void FilterTracker::list_overlaps(Seen seen) {
  grid_.build(points_, crowd_.widest());
  pairs_.clear();
  for (int row = 0; row < std::ssize(targets_); ++row) {
    const Target& target = targets_[row];
    if (!target.confirmed() || target.observation || !target.size || !was_seen_recently(target)) continue;
    const Box box = target.size->around(target.filter.position());
    grid_.for_each_near(target.filter.position(), target.unit, [&](int column) {
      const double overlap = geometry::iou(box, *seen[candidates_[column]].box);
      if (overlap > kOverlap) pairs_.push_back({row, column, overlap});
    });
  }
}

void FilterTracker::match_reappeared(Seen seen) {
  if (!options_.reidentify) return;
  reidentification_.match(targets_, seen, *now_, {options_.evidence.confident, size_options_, gate_});
}

void FilterTracker::mark_taken(Seen seen) {
  taken_.assign(seen.size(), 0);
  for (const Target& target : targets_) {
    if (target.observation) taken_[*target.observation] = 1;
  }
}

/// A target that has merged with others stays within their region, keeps its size and waits for it to part; none begins there.
void FilterTracker::keep_merged(Seen seen) {
  merged_.assign(seen.size(), 0);
  crowd_.find_merged(targets_, seen, merged_,
                     [this](Target& target, const Observation<2>& region) { stay_within(target, region); });
}

void FilterTracker::stay_within(Target& target, const Observation<2>& region) const {
  const double sigma = kUnbelieved * options_.place_noise * target.unit;
  const Matrix<2> R = region.covariance + sigma * sigma * Matrix<2>::Identity();
  target.filter.correct(target.size->centre_within(*region.box, target.filter.position()), R);
  target.hidden = true;
}

void FilterTracker::correct(Seen seen) {
  for (Target& target : targets_) {
    if (target.observation) correct(target, seen[*target.observation], merged_[*target.observation] != 0);
  }
  crowd_.mark_hidden(targets_, seen);
}

void FilterTracker::correct(Target& target, const Observation<2>& observation, bool merged) const {
  if (merged) {
    stay_within(target, observation);
  } else {
    target.filter.correct(place_of(observation, target), noise_of(observation, target));
  }
  if (!merged && has_extent(observation) && !observation.shared && target.size) {
    target.size->correct(*observation.box, size_options_);
    target.unit = target.size->height();
    if (options_.learn_noise) target.shown = shown_box(target, *observation.box);
  }
  if (options_.reidentify && observation.box) {
    const bool whole = !merged && !observation.shared && observation.score >= options_.evidence.confident;
    target.unoccluded_motion.see(*now_, dt_, target.filter.position(), target.filter.velocity(), observation.box->height, whole);
  }
  target.last_seen = *now_;
  target.score = observation.score;
  target.evidence.see(observation.score, options_.evidence);
}

/// The box as it is written: nearer to what was seen than the filters are, by what of the difference is there in the next frame
/// too. A side that is not believed stays as it is.
std::optional<Box> FilterTracker::shown_box(const Target& target, const Box& seen) const {
  if (!target.size->believes(seen, size_options_)) return std::nullopt;
  const Vector<2> centre = target.filter.position() + believed_place_ * (seen.centre() - target.filter.position());
  const auto side = [&](double filtered, double as_seen) { return filtered * std::pow(as_seen / filtered, believed_size_); };
  return Box::from_centre(centre, side(target.size->width(), seen.width), side(target.size->height(), seen.height));
}

void FilterTracker::count_misses() {
  const double miss = std::min(options_.evidence.miss, (options_.reidentify ? kExpectedBack : kMissesASecond) * dt_);
  for (Target& target : targets_) {
    if (!target.observation) target.evidence.miss(target.hidden ? kHiddenMiss : miss);
  }
}

void FilterTracker::retire_lost() {
  std::erase_if(targets_, [&](const Target& target) {
    const double unseen = seconds(*now_ - target.last_seen);
    if (unseen <= 0) return false;
    if (target.evidence.refuted()) return true;
    if (!target.confirmed()) return unseen > std::max(options_.evidence.tentative_patience, kNextFrame * dt_);
    const double patience = target.hidden ? options_.hidden_patience : options_.patience;
    return unseen > options_.evidence.patience(patience, seconds(target.last_seen - target.born));
  });
}

void FilterTracker::start_unmatched(Seen seen) {
  mark_taken(seen);
  points_.clear();
  double widest = 1e-9;
  for (const Observation<2>& one : seen) {
    points_.push_back(centre_of(one));
    if (one.box) widest = std::max(widest, one.box->height / 2);
  }
  grid_.build(points_, widest);
  for (int i = 0; i < std::ssize(seen); ++i) {
    if (taken_[i] || merged_[i] || seen[i].score < options_.evidence.confident || is_duplicate(i, seen)) continue;
    start(seen[i], i);
    taken_[i] = 1;
  }
}

/// A detector's second box around what a target is matched with already. `grid_` holds the centres of all that was seen.
bool FilterTracker::is_duplicate(int index, Seen seen) const {
  bool found = false;
  if (!seen[index].box) return found;
  grid_.for_each_near(centre_of(seen[index]), seen[index].box->height / 2, [&](int other) {
    found = found || (taken_[other] && seen[other].box &&
                      geometry::iou(*seen[other].box, *seen[index].box) > options_.evidence.duplicate_iou);
  });
  return found;
}

void FilterTracker::start(const Observation<2>& observation, int index) {
  const bool has_box = has_extent(observation);
  const double unit = has_box ? observation.box->height : 1.0;
  Matrix<2> R = observation.covariance;
  if (has_box) R.diagonal() = R.diagonal().cwiseMax(Vector<2>::Constant(std::pow(options_.place_noise * unit, 2)));
  Target& target = targets_.emplace_back(Target{.id = TrackId{next_id_++},
                                                .filter = {filter::scaled(options_.filter, unit), centre_of(observation), R},
                                                .size = {},
                                                .unit = unit,
                                                .born = *now_,
                                                .last_seen = *now_,
                                                .evidence = Evidence(observation.score, options_.evidence),
                                                .score = observation.score,
                                                .observation = index});
  target.filter.scale_noise(noise_scale_);
  if (has_box) target.size.emplace(*observation.box, size_options_);
}

Track<2> FilterTracker::track_of(const Target& target) const {
  const geometry::Similarity2& view_from_scene = camera_.view_from_scene();
  const Matrix<2>& turn = view_from_scene.turn;
  Track<2> track;
  track.id = target.id;
  track.position = view_from_scene * target.filter.position();
  track.velocity = turn * target.filter.velocity();
  track.covariance = turn * target.filter.covariance() * turn.transpose();
  track.state = target.observation ? Track<2>::State::observed : Track<2>::State::predicted;
  track.observation = target.observation;
  track.confirmed = target.confirmed();
  if (target.size) track.box = view_from_scene * target.shown.value_or(target.size->around(target.filter.position()));
  if (target.shown) track.position = track.box->centre();
  track.score = target.score;
  return track;
}

std::span<const Track<2>> FilterTracker::report() {
  tracks_.clear();
  for (const Target& target : targets_) tracks_.push_back(track_of(target));
  match_by_observation();
  return tracks_;
}

}  // namespace marey::track
