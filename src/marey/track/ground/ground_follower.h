// The loop that gnn and jpda share: predict, take in one camera's look after the other, merge what turned out to be one person, end
// and report. How a look's observations find their targets is left to the association.
// Cost an instant: looks · (targets + observations) while gates hold few observations.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "marey/assign/point_grid.h"
#include "marey/track/check_frame.h"
#include "marey/track/ground/ground_duplicates.h"
#include "marey/track/ground/ground_sight.h"
#include "marey/track/ground/ground_target.h"

namespace marey::track::ground {

/// A target and an observation of one look within its gate.
template <typename F>
struct GroundPair {
  int target = 0;
  int observation = 0;
  double log_ratio = 0;  ///< GroundRules::log_ratio
};

template <typename F>
class GroundFollower : public GroundTracker {
 public:
  GroundFollower(const GroundTrackerOptions& options, const typename F::Options& filter, std::vector<GroundView> views)
      : rules_(options, filter, static_cast<int>(views.size())), sight_(std::move(views)) {}

  std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations> looks) final {
    check_time(now, now_);
    for (const CameraObservations& look : looks) sight_.check(look);
    predict_to(now);
    claims_.clear();
    for (int i = 0; i < static_cast<int>(looks.size()); ++i) take_in(i, looks[i]);
    merge_duplicates();
    retire_lost();
    return report();
  }

  std::span<const ObservationMatch> claims() const final { return claims_; }

  std::span<const GroundDecision> decided() final {
    decision_ = {now_.value_or(Timestamp{}), tracks_, claims_};
    return {&decision_, now_ ? std::size_t{1} : 0};
  }

  std::span<const GroundDecision> decide_all() final { return {}; }

  std::span<const Track<2>> expected(Timestamp now) final {
    const double dt = now_ ? std::max(0.0, seconds(now - *now_)) : 0.0;
    tracks_.clear();
    for (const GroundTarget<F>& target : targets_) {
      if (!target.confirmed) continue;
      GroundTarget<F> ahead = target;
      rules_.predict(ahead, dt);
      tracks_.push_back(rules_.report(ahead));
    }
    return tracks_;
  }

 protected:
  /// Corrects targets by what they are given of `seen`, which is brought to the instant nowhere yet (GroundRules::at_instant), and
  /// tells by `claim` whose each observation is. `pairs` are by target, then by observation.
  virtual void associate(std::span<GroundTarget<F>> targets, std::span<const Observation<2>> seen, double late,
                         std::span<const GroundPair<F>> pairs) = 0;

  /// What a pair is worth against clutter and a miss together: who is given nothing was missed.
  double gain_of(std::span<const GroundTarget<F>> targets, const GroundPair<F>& pair) const {
    const double visible = targets[pair.target].presence.visible();
    return pair.log_ratio + std::log(visible) - std::log1p(-visible * rules_.options().detected);
  }

  /// The observation is this target's. An observation that is nobody's may begin a target.
  void claim(int target, int observation) { owner_[observation] = target; }

  /// Nothing is known to belong to the observation, yet it is explained: nobody begins there.
  void explain(int observation) { explained_[observation] = 1; }

  const GroundRules<F>& rules() const { return rules_; }
  const GroundSight& sight() const { return sight_; }
  Timestamp now() const { return *now_; }

 private:
  void predict_to(Timestamp now) {
    const double dt = now_ ? seconds(now - *now_) : 0.0;
    now_ = now;
    for (GroundTarget<F>& target : targets_) rules_.predict(target, dt);
  }

  void take_in(int index, const CameraObservations& look) {
    const double late = seconds(look.time - *now_);
    sight_.look(look.camera, look.seen, rules_.options().confident);
    owner_.assign(look.seen.size(), nobody);
    explained_.assign(look.seen.size(), 0);
    find_pairs(look.seen, late);
    associate(targets_, look.seen, late, pairs_);
    note_missed();
    for (int i = 0; i < static_cast<int>(look.seen.size()); ++i) {
      if (owner_[i] != nobody) claims_.push_back({targets_[owner_[i]].id, index, i});
    }
    start_unclaimed(index, look);
  }

  void find_pairs(std::span<const Observation<2>> seen, double late) {
    pairs_.clear();
    points_.clear();
    double widest = 0;
    for (const Observation<2>& one : seen) {
      points_.push_back(one.value);
      widest = std::max(widest, one.covariance.trace());
    }
    grid_.build(points_, 1 + 2 * std::sqrt(widest));
    for (int i = 0; i < static_cast<int>(targets_.size()); ++i) {
      const GroundTarget<F>& target = targets_[i];
      const double radius = rules_.search_radius(target, widest) + std::abs(late) * rules_.options().max_speed;
      const std::size_t first = pairs_.size();
      grid_.for_each_near(target.filter.position(), radius, [&](int o) {
        if (seen[o].score < rules_.options().weak) return;
        const auto ratio = rules_.log_ratio(target, seen[o], rules_.at_instant(target, seen[o], late), *now_);
        if (ratio) pairs_.push_back({i, o, *ratio});
      });
      std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(first), pairs_.end(),
                [](const auto& a, const auto& b) { return a.observation < b.observation; });
    }
  }

  void note_missed() {
    seen_now_.assign(targets_.size(), 0);
    for (const int owner : owner_) {
      if (owner != nobody) seen_now_[owner] = 1;
    }
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (!seen_now_[i]) rules_.miss(targets_[i], sight_.visible(targets_[i].filter.position()));
    }
  }

  void start_unclaimed(int index, const CameraObservations& look) {
    for (int i = 0; i < static_cast<int>(look.seen.size()); ++i) {
      const Observation<2>& one = look.seen[i];
      if (owner_[i] != nobody || explained_[i] || one.score < rules_.options().confident || is_duplicate(i, look.seen)) continue;
      owner_[i] = static_cast<int>(targets_.size());
      targets_.push_back(rules_.start(TrackId{next_id_++}, *now_, one));
      claims_.push_back({targets_.back().id, index, i});
    }
  }

  /// A detector's second box around what a target has claimed already.
  bool is_duplicate(int index, std::span<const Observation<2>> seen) const {
    if (!seen[index].box) return false;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (owner_[i] != nobody && seen[i].box && iou(*seen[i].box, *seen[index].box) > duplicate_iou) return true;
    }
    return false;
  }

  void merge_duplicates() {
    members_.clear();
    for (const GroundTarget<F>& target : targets_)
      members_.push_back({target.id, target.filter.position(), target.filter.covariance(), target.cameras});
    const auto& merges = duplicates_.find(*now_, members_, rules_.options().disagreement);
    for (const auto& [kept, gone] : merges) {
      const auto target = at(gone);
      const auto into = at(kept);
      rules_.absorb(*into, *target);
      for (ObservationMatch& one : claims_) {
        if (one.track == gone) one.track = kept;
      }
      targets_.erase(target);
    }
  }

  typename std::vector<GroundTarget<F>>::iterator at(TrackId id) {
    return std::lower_bound(targets_.begin(), targets_.end(), id,
                            [](const GroundTarget<F>& t, TrackId wanted) { return t.id < wanted; });
  }

  void retire_lost() {
    std::erase_if(targets_, [&](const GroundTarget<F>& target) { return rules_.lost(target, *now_); });
  }

  std::span<const Track<2>> report() {
    tracks_.clear();
    for (const GroundTarget<F>& target : targets_) tracks_.push_back(rules_.report(target));
    return tracks_;
  }

  static constexpr int nobody = -1;
  static constexpr double duplicate_iou = 0.75;

  GroundRules<F> rules_;
  GroundSight sight_;
  GroundDuplicates duplicates_;
  std::optional<Timestamp> now_;
  int next_id_ = 1;
  std::vector<GroundTarget<F>> targets_;  // in the order of their ids
  std::vector<Track<2>> tracks_;
  std::vector<ObservationMatch> claims_;
  GroundDecision decision_;
  // What a look needs, kept so that it is allocated once.
  std::vector<int> owner_;  // of each observation: index of its target
  std::vector<char> explained_, seen_now_;
  std::vector<Vector<2>> points_;
  std::vector<GroundPair<F>> pairs_;
  std::vector<GroundDuplicates::Member> members_;
  assign::PointGrid<2> grid_;  // of observations
};

}  // namespace marey::track::ground
