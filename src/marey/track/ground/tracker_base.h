// The loop that gnn and jpda share: predict, take in one camera's view after the other, merge what turned out to be one person, end
// and report. How a view's observations find their targets is left to the association.
// Cost an instant: views · (targets + observations) while gates hold few observations.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/assign/point_grid.h"
#include "marey/track/ground/ground_duplicates.h"
#include "marey/track/ground/ground_target.h"
#include "marey/track/ground/ground_visibility.h"
#include "marey/track/immediate_tracker.h"

namespace marey::track::ground {

/// A target and an observation of one view within its gate.
struct GroundPair {
  int target = 0;
  int observation = 0;
  double log_ratio = 0;  ///< GroundRules::log_ratio
};

class GroundTrackerBase : public ImmediateTracker<2> {
 public:
  GroundTrackerBase(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views);

  using ImmediateTracker<2>::step;
  std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations> views) final;
  std::span<const Track<2>> expected(Timestamp now) final;

 protected:
  /// Corrects targets by what they are given of `seen`, which is brought to the instant nowhere yet (GroundRules::at_instant), and
  /// says by `match` which target each observation is of. `pairs` are by target, then by observation.
  virtual void associate(std::span<GroundTarget> targets, std::span<const Observation<2>> detected, double late,
                         std::span<const GroundPair> pairs) = 0;

  /// What a pair is worth against clutter and a miss together: a target that is given nothing was missed.
  double gain_of(std::span<const GroundTarget> targets, const GroundPair& pair) const;

  /// The observation is this target's. An observation without a target may begin one.
  void match(int target, int observation) { target_of_[observation] = target; }

  /// The observation is not known to be any one target's, yet it is explained: none begins there.
  void explain(int observation) { explained_[observation] = 1; }

  const GroundRules& rules() const { return rules_; }
  Timestamp now() const { return *now_; }

 private:
  void predict_to(Timestamp now);
  void take_in(int index, const CameraObservations& view);
  void find_pairs(std::span<const Observation<2>> detected, double late);
  void note_missed();
  void start_unmatched(int index, const CameraObservations& view);
  bool is_duplicate(int index, std::span<const Observation<2>> detected) const;
  void merge_duplicates();
  std::vector<GroundTarget>::iterator at(TrackId id);
  std::span<const Track<2>> report();

  GroundRules rules_;
  GroundVisibility visibility_;
  GroundDuplicates duplicates_;
  int next_id_ = 1;
  std::vector<GroundTarget> targets_;  // in the order of their ids
  // What a view needs, kept so that it is allocated once.
  std::vector<std::optional<int>> target_of_;  // of each observation
  std::vector<char> explained_, observed_now_;
  std::vector<Vector<2>> points_;
  std::vector<GroundPair> pairs_;
  std::vector<GroundDuplicates::Member> members_;
  assign::PointGrid<2> grid_;  // of observations
};

}  // namespace marey::track::ground
