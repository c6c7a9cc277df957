#include "experiments/independent_tracker.h"

#include <cassert>
#include <limits>

namespace marey::experiments {

std::span<const Track<2>> IndependentTracker::step(Timestamp now, std::span<const track::CameraObservations<2>> views) {
  assert(views.size() == 1 && "an image is one camera's");
  assert((targets_.empty() || now > *now_) && "frames come in the order of their time");
  const std::span<const Observation<2>> detected = views.front().detected;
  if (targets_.empty()) {
    for (int i = 0; i < std::ssize(detected); ++i) targets_.push_back({{options_, detected[i].value, *detected[i].covariance}, i});
  } else {
    for (Target& target : targets_) step_target(target, seconds_to(now), detected);
  }
  now_ = now;
  return report(targets_);
}

std::span<const Track<2>> IndependentTracker::expected(Timestamp now) {
  std::vector<Target> ahead = targets_;
  for (Target& target : ahead) {
    target.filter.predict(seconds_to(now));
    target.observation.reset();
  }
  return report(ahead);
}

void IndependentTracker::step_target(Target& target, double dt, std::span<const Observation<2>> detected) {
  target.filter.predict(dt);
  const Observation<2>* nearest = nullptr;
  double minimum = std::numeric_limits<double>::infinity();
  for (const Observation<2>& point : detected) {
    const double distance = (point.value - target.filter.position()).norm();
    if (distance < minimum && target.filter.gate_distance(point.value, *point.covariance) <= 1) {
      minimum = distance;
      nearest = &point;
    }
  }
  target.observation.reset();
  if (nearest == nullptr) return;
  target.observation = static_cast<int>(nearest - detected.data());
  target.filter.correct(nearest->value, *nearest->covariance);
}

std::span<const Track<2>> IndependentTracker::report(std::span<const Target> targets) {
  tracks_.resize(targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    tracks_[i].id = TrackId{static_cast<int>(i) + 1};
    tracks_[i].position = targets[i].filter.position();
    tracks_[i].velocity = targets[i].filter.velocity();
    tracks_[i].covariance = targets[i].filter.covariance();
    tracks_[i].observation = targets[i].observation;
    tracks_[i].provenance = targets[i].observation ? Provenance::measured : Provenance::predicted;
  }
  match_by_observation();
  return tracks_;
}

}  // namespace marey::experiments
