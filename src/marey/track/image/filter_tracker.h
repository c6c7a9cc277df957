// The tracker of people and points in one image: predict, gate, assign, correct; birth and death by evidence.
//
// A pair of target and observation is gated by chi-square distance and by speed, and weighed by the logarithm of its likelihood
// against that of clutter: place, size, overlap. The assignment that maximises the sum over all pairs wins (globally nearest
// neighbour), confident observations first, then what weak ones can still explain (after Zhang et al., "ByteTrack", 2022).
// A target begins with a confident observation that matches none, is confirmed by further evidence, and is given up when it
// has not been seen for too long: sooner where it should be visible, later where another target hides it.
// Cost a frame: near linear in targets + observations while gates hold few observations (assign/gated_assignment.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/point_grid.h"
#include "marey/track/image/box_noise.h"
#include "marey/track/image/clutter.h"
#include "marey/track/image/crowd.h"
#include "marey/track/image/reidentification.h"
#include "marey/track/image/scene_view.h"
#include "marey/track/image/target.h"
#include "marey/track/immediate_tracker.h"

namespace marey::track::image {

class FilterTracker final : public ImmediateTracker<2> {
 public:
  explicit FilterTracker(const TrackerOptions& options);

  using ImmediateTracker<2>::step;
  std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations<2>> views) override;
  std::span<const Track<2>> expected(Timestamp now) override;
  geometry::Similarity2 view_from_scene() const override { return scene_.view_from_scene(); }
  std::optional<BoxNoise> learned_noise() const override;

 private:
  using Detected = std::span<const Observation<2>>;

  static constexpr double kUntrusted = 2.5;  // a box that is not trusted places its target this much less surely
  static constexpr double kNextFrame = 1.5;  // steps: a target may be missing from one frame

  void predict_to(Timestamp now);
  Detected in_scene(Detected detected);
  void learn_noise(Detected detected);
  Vector<2> position_of(const Observation<2>& observation, const Target& target) const;
  Matrix<2> noise_of(const Observation<2>& observation, const Target& target) const;
  double reach(const Target& target) const;
  double search_radius(const Target& target) const;
  Matrix<2> innovation_of(const Target& target, const Matrix<2>& R) const;
  bool was_observed_recently(const Target& target) const;
  double missed_for(const Target& target) const;
  double gain(const Target& target, const Observation<2>& observation) const;

  void match_gated(Detected detected, double min_score, double below_score);
  void match_overlapping(Detected detected);
  void list_overlaps(Detected detected);
  void match_reappeared(Detected detected);
  void mark_taken(Detected detected);
  void keep_merged(Detected detected);
  void stay_within(Target& target, const Observation<2>& region) const;

  void correct(Detected detected);
  void correct(Target& target, const Observation<2>& observation, bool merged) const;
  void count_misses();
  void retire_lost();
  void start_unmatched(Detected detected);
  void start(const Observation<2>& observation, int index);
  bool is_duplicate(int index, Detected detected) const;

  static Track<2> track_of(const Target& target, const geometry::Similarity2& view_from_scene);
  std::span<const Track<2>> report();

  TrackerOptions options_;
  BoxSizeOptions size_options_;
  double gate_;
  double dt_ = 0;  // s since the frame before
  SceneView scene_;
  Clutter clutter_;
  BoxNoiseLevels first_;
  BoxNoise noise_;
  double noise_scale_ = 1;  // of the acceleration, beside the options
  LastingFractions lasting_;
  double unlearned_ = 0;  // s since noise was last learned
  int next_id_ = 1;
  std::vector<Target> targets_;  // in the order of their ids
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> candidates_, free_targets_;
  std::vector<Vector<2>> points_;
  std::vector<Sighting> expected_;
  std::vector<assign::GatedPair> pairs_;
  std::vector<char> taken_, merged_;  // of each observation
  assign::PointGrid<2> grid_;         // of observations
  Crowd crowd_;
  Reidentification reidentification_;
  assign::GatedAssigner assigner_;
};

}  // namespace marey::track::image
