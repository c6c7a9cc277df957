// The tracker of the OpenMoCap paper: every target for itself. A target looks inside its own filter's search area and takes the
// nearest point there; nobody asks whether another target has taken the same point. Targets begin at the points of the first
// frame that has any, and are never lost: where nothing is found the filter coasts. This is what the global assignment of
// `FilterTracker` and `RosterTracker` is measured against; it is for experiments, not for use.
//
// Source: Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion Capture
// System", §I and §IV. Cost: targets × points a step.
#pragma once

#include <cassert>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "marey/filter/filter.h"
#include "marey/track/tracker.h"

namespace marey::track {

template <filter::Filter F>
class IndependentTracker final : public Tracker<F::dimension> {
 public:
  static constexpr int D = F::dimension;

  explicit IndependentTracker(typename F::Options options) : options_(std::move(options)) {}

  std::span<const Track<D>> step(Timestamp now, std::span<const Observation<D>> seen) override {
    assert((targets_.empty() || now > last_) && "frames come in the order of their time");
    if (targets_.empty()) {
      start(seen);
    } else {
      for (Target& target : targets_) follow(target, seconds(now - last_), seen);
    }
    last_ = now;
    return report(targets_);
  }

  std::span<const Track<D>> expected(Timestamp now) override {
    std::vector<Target> ahead = targets_;
    for (Target& target : ahead) {
      target.filter.predict(seconds(now - last_));
      target.observation.reset();
    }
    return report(ahead);
  }

 private:
  struct Target {
    F filter;
    std::optional<int> observation;
  };

  void start(std::span<const Observation<D>> seen) {
    for (const Observation<D>& point : seen) {
      targets_.push_back({F(options_, point.value, point.covariance), static_cast<int>(&point - seen.data())});
    }
  }

  void follow(Target& target, double dt, std::span<const Observation<D>> seen) {
    target.filter.predict(dt);
    const Observation<D>* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Observation<D>& point : seen) {
      const double distance = (point.value - target.filter.position()).norm();
      if (distance < least && target.filter.gate_distance(point.value, point.covariance) <= 1) {
        least = distance;
        nearest = &point;
      }
    }
    target.observation.reset();
    if (nearest == nullptr) return;
    target.observation = static_cast<int>(nearest - seen.data());
    target.filter.correct(nearest->value, nearest->covariance);
  }

  std::span<const Track<D>> report(const std::vector<Target>& targets) {
    tracks_.resize(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
      tracks_[i].id = TrackId{static_cast<int>(i) + 1};
      tracks_[i].position = targets[i].filter.position();
      tracks_[i].velocity = targets[i].filter.velocity();
      tracks_[i].covariance = targets[i].filter.covariance();
      tracks_[i].observation = targets[i].observation;
      tracks_[i].state = targets[i].observation ? Track<D>::State::observed : Track<D>::State::predicted;
    }
    return tracks_;
  }

  typename F::Options options_;
  std::vector<Target> targets_;
  std::vector<Track<D>> tracks_;
  Timestamp last_{};
};

}  // namespace marey::track
