#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/track/target.h"

namespace marey::track {

/// Before a camera that stands still, nobody vanishes but behind something: somebody of his size who appears where he may have
/// gone by now, and whom nobody else claims, is he. So is who was seen a moment ago, and turned so sharply that he left his gate.
template <typename F>
class Reidentification {
 public:
  /// Gives such observations, of at least `least_score`, to confirmed targets that have none and are not hidden by another. Where
  /// an observation is seen for a target says `place_of`; sizes that differ by more than `gate` (squared deviations) are another's.
  template <typename PlaceOf>
  void claim(std::span<Target<F>> targets, std::span<const Observation<2>> seen, Timestamp now, double least_score,
             const BoxSizeOptions& sizes, double gate, PlaceOf&& place_of) {
    claimed_.assign(seen.size(), 0);
    for (const Target<F>& target : targets) {
      if (target.observation >= 0) claimed_[target.observation] = 1;
    }
    pairs_.clear();
    for (int row = 0; row < static_cast<int>(targets.size()); ++row) {
      const Target<F>& target = targets[row];
      if (!target.confirmed || target.observation >= 0 || target.hidden || !target.size) continue;
      for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
        if (claimed_[i] || !seen[i].box || seen[i].shared || seen[i].score < least_score) continue;
        if (target.size->distance(*seen[i].box, sizes) > gate) continue;
        const double worth = nearness(target, place_of(seen[i], target), now);
        if (worth > 0) pairs_.push_back({row, i, worth});
      }
    }
    if (pairs_.empty()) return;
    const auto columns = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(seen.size()), pairs_);
    for (int row = 0; row < static_cast<int>(targets.size()); ++row) {
      if (columns[row] != assign::GatedAssigner::nobody) targets[row].observation = columns[row];
    }
  }

 private:
  /// 0 where it is too far from where the target is expected, by its filter or by how it moved while all of it was seen.
  static double nearness(const Target<F>& target, const Vector<2>& place, Timestamp now) {
    const double farthest = target.unit * (within + speed * seconds(now - target.last_seen));
    double distance = (place - target.filter.position()).norm();
    if (const auto cruised = target.cruise.place_at(now)) distance = std::min(distance, (place - *cruised).norm());
    return distance > farthest ? 0 : 1 + farthest - distance;
  }

  static constexpr double within = 0.3;  // sizes: this far from where it is expected,
  static constexpr double speed = 0.5;   // sizes/s: and so much farther for each second

  std::vector<char> claimed_;
  std::vector<assign::GatedPair> pairs_;
  assign::GatedAssigner assigner_;
};

}  // namespace marey::track
