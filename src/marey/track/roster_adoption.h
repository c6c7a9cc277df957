// The step that brings back the lost: targets that are missed and points that nobody claims are brought together within the reach
// of the greatest speed, at once where false points are rare; else once the point has proved, as a newcomer, that it stays. Of all
// pairs within reach the assignment with the shortest ways wins. Cost: lost × unclaimed.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/track/companions.h"
#include "marey/track/roster_target.h"

namespace marey {

template <typename F>
class RosterAdoption {
 public:
  static constexpr int D = F::dimension;
  using Target = RosterTarget<F>;

  RosterAdoption(const RosterTrackerOptions& options, const typename F::Options& filter_options)
      : options_(options), filter_options_(filter_options) {}

  /// Gives targets that are missed what they are thought to be seen as, and marks it in `claimed`, one entry a point.
  void find_lost(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& claimed, RosterSight<F>& sight,
                 const Companions& companions) {
    lost_.clear();
    free_.clear();
    for (int i = 0; i < std::ssize(targets); ++i) {
      if (targets[i].observation == Target::kNone && targets[i].covered_by == Target::kNone &&
          targets[i].standing == Target::Standing::established)
        lost_.push_back(i);
    }
    for (int i = 0; i < std::ssize(seen); ++i) {
      if (!claimed[i]) free_.push_back(i);
    }
    sight.count_unexplained(std::max<double>(0, static_cast<double>(free_.size()) - static_cast<double>(lost_.size())));
    if (lost_.empty()) return;
    adopt_points(targets, seen, claimed, sight, companions);
    adopt_newcomers(targets, companions);
  }

 private:
  /// How far a target's own motion leaves it from a place; where it turned or stopped unseen, its last place tells better.
  double way_to(const Target& target, const Vector<D>& place) const {
    if (target.guided > 0) return (place - target.filter.position()).norm();
    return std::min((place - target.filter.position()).norm(), (place - target.last_place).norm());
  }

  /// Whether a target that was lost can be at a place. Where enough of those that move with it are seen, their word counts.
  bool may_be_at(const Target& target, const Vector<D>& place, const Companions& companions) const {
    if constexpr (D == 3) {
      if (target.member) {
        if (const auto misfit = companions.misfit(*target.member, place)) return *misfit < kMostMisfit;
      }
    }
    if (target.guided > 0) return false;  // the search area has been looked through
    if (options_.companions) {            // who is not known yet does not jump onto what may be his neighbour's
      const double reach = kUnknownReach * std::sqrt(target.filter.covariance().trace() / D) + target.width / 2;
      return (place - target.filter.position()).norm() <= reach;
    }
    return (place - target.last_place).norm() <= options_.max_speed * target.unseen + target.width;
  }

  void adopt_points(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& claimed,
                    const RosterSight<F>& sight, const Companions& companions) {
    if (free_.empty() || std::ssize(lost_) * std::ssize(free_) > kMostLostPairs) return;
    pairs_.clear();
    for (int row = 0; row < std::ssize(lost_); ++row) {
      const Target& target = targets[lost_[row]];
      for (int column = 0; column < std::ssize(free_); ++column) {
        const Vector<D>& place = seen[free_[column]].value;
        if (!may_be_at(target, place, companions) || !sight.alike(target, seen[free_[column]])) continue;
        const double way = way_to(target, place);
        if (!sight.believes_jump(way + target.width)) continue;
        pairs_.push_back({row, column, 2 * kFar - std::min(way, kFar)});
      }
    }
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(free_.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == GatedAssigner::nobody) continue;
      const int index = free_[columns[row]];
      begin_anew(targets[lost_[row]], seen[index].value, sight.noise_of(seen[index]));
      targets[lost_[row]].observation = index;
      claimed[index] = 1;
    }
  }

  /// The motion before the jump tells little of the motion after it; half of the velocity seen since is kept for the start.
  void begin_anew(Target& target, const Vector<D>& place, const Matrix<D>& R) {
    const double jump = (place - target.filter.position()).norm();
    if (target.filter.gate_distance(place, R) <= kGentleJump || jump < target.width) return;
    F fresh(filter_options_, target.last_place, R);
    fresh.predict(target.unseen);
    if (fresh.gate_distance(place, R) > 1) fresh = F(filter_options_, place, R);
    target.filter = fresh;
  }

  /// A newcomer that has stayed is one of those who are missed.
  void adopt_newcomers(std::span<Target> targets, const Companions& companions) {
    pairs_.clear();
    proven_.clear();
    for (int i = 0; i < std::ssize(targets); ++i) {
      const Target& newcomer = targets[i];
      if (!newcomer.on_roster() && newcomer.observation != Target::kNone && newcomer.score >= options_.confirm)
        proven_.push_back(i);
    }
    for (int row = 0; row < std::ssize(lost_); ++row) {
      const Target& target = targets[lost_[row]];
      if (target.observation != Target::kNone) continue;
      for (const int column : proven_) {
        const Target& newcomer = targets[column];
        if (!may_be_at(target, newcomer.last_place, companions)) continue;
        pairs_.push_back({row, column, 2 * kFar - std::min(way_to(target, newcomer.last_place), kFar)});
      }
    }
    if (pairs_.empty()) return;
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(targets.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == GatedAssigner::nobody) continue;
      Target& target = targets[lost_[row]];
      Target& newcomer = targets[columns[row]];
      target.filter = newcomer.filter;
      target.observation = newcomer.observation;
      newcomer.observation = Target::kNone;
    }
  }

  static constexpr double kGentleJump = 1;           // gates
  static constexpr double kUnknownReach = 3.5;       // standard deviations
  static constexpr double kMostMisfit = 4;           // variances
  static constexpr double kFar = 1e6;                // px
  static constexpr long kMostLostPairs = 1'000'000;  // glare: nobody is looked for in it

  RosterTrackerOptions options_;
  typename F::Options filter_options_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> lost_, free_, proven_;
  std::vector<GatedPair> pairs_;
  GatedAssigner assigner_;
};

}  // namespace marey
