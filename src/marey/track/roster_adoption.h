// The step that brings back the lost: targets that are missed and points that nobody claims are brought together within the reach
// of the greatest speed, at once where false points are rare; else once the point has proved, as a newcomer, that it stays. Of all
// pairs within reach the assignment with the shortest ways wins. Cost: lost × unclaimed.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/track/rigid_neighbours.h"
#include "marey/track/roster_target.h"

namespace marey::track {

template <typename F>
class RosterAdoption {
 public:
  static constexpr int D = F::dimension;
  using Target = RosterTarget<F>;

  RosterAdoption(const RosterTrackerOptions& options, const typename F::Options& filter_options)
      : options_(options), filter_options_(filter_options) {}

  /// Gives targets that are missed what they are thought to be seen as, and marks it in `claimed`, one entry a point.
  void find_lost(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& claimed,
                 RosterSight<F>& sight, const RigidNeighbours& companions) {
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

  /// What it costs to believe that a target that was lost is at a place; nothing where it cannot be. Where enough of those that
  /// move with it are seen, their word counts; else the way. Of who has `stayed` there for a while less is asked: somebody he must
  /// be.
  std::optional<double> cost(const Target& target, const Vector<D>& place, const RigidNeighbours& companions, bool stayed) const {
    if constexpr (D == 3) {
      if (target.member) {
        if (const auto misfit = companions.misfit(*target.member, place)) {
          return *misfit < (stayed ? kMostOfStayed : kMostMisfit) ? misfit : std::nullopt;
        }
      }
    }
    const bool jumps = !options_.companions || stayed;
    if (!jumps && target.guided > 0) return std::nullopt;  // the search area has been looked through
    if (!jumps) {                                          // who is not known yet does not jump onto what may be his neighbour's
      const double reach = kUnknownReach * std::sqrt(target.filter.covariance().trace() / D) + target.width / 2;
      if ((place - target.filter.position()).norm() > reach) return std::nullopt;
      return kUnknown + way_to(target, place);
    }
    if ((place - target.last_place).norm() > options_.max_speed * target.unseen + target.width) return std::nullopt;
    if (options_.companions && way_to(target, place) > kShortWay * target.width) return std::nullopt;
    return (options_.companions ? kUnknown : 0) + way_to(target, place);
  }

  void adopt_points(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& claimed,
                    const RosterSight<F>& sight, const RigidNeighbours& companions) {
    if (free_.empty() || std::ssize(lost_) * std::ssize(free_) > kMostLostPairs) return;
    pairs_.clear();
    for (int row = 0; row < std::ssize(lost_); ++row) {
      const Target& target = targets[lost_[row]];
      for (int column = 0; column < std::ssize(free_); ++column) {
        const Vector<D>& place = seen[free_[column]].value;
        const auto price = cost(target, place, companions, false);
        if (!price || !sight.alike(target, seen[free_[column]])) continue;
        if (!sight.believes_jump(way_to(target, place) + target.width)) continue;
        pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
      }
    }
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(free_.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == assign::GatedAssigner::nobody) continue;
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
  void adopt_newcomers(std::span<Target> targets, const RigidNeighbours& companions) {
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
        const auto price = cost(target, newcomer.last_place, companions, options_.companions && newcomer.seen > kStayed);
        if (price) pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
      }
    }
    if (pairs_.empty()) return;
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(targets.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == assign::GatedAssigner::nobody) continue;
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
  static constexpr double kMostOfStayed = 12;        // the same for a newcomer who stays
  static constexpr double kStayed = 0.5;             // s
  static constexpr double kShortWay = 5;             // marker widths that who is not known may have gone astray
  static constexpr double kUnknown = 100;            // variances: who is known by companions goes first
  static constexpr double kFar = 1e6;                // px
  static constexpr long kMostLostPairs = 1'000'000;  // glare: nobody is looked for in it

  RosterTrackerOptions options_;
  typename F::Options filter_options_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> lost_, free_, proven_;
  std::vector<assign::GatedPair> pairs_;
  assign::GatedAssigner assigner_;
};

}  // namespace marey::track
