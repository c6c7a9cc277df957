#include "marey/track/roster/encounters.h"

#include <algorithm>

namespace marey::track::roster {
namespace {

constexpr double kCrowded = 1.4;  // marker widths between two that disturb each other's centres
constexpr std::size_t kFewTargets = 64;

}  // namespace

template <int D>
void RosterEncounters<D>::meet(std::span<Target> targets, std::span<const Observation<D>> detected,
                               const RosterLikelihood<D>& likelihood) {
  mark_crowded(targets);
  for (Target& target : targets) {
    if (target.observation || !target.crowded) continue;
    double nearest = target.width;
    for (const Target& other : targets) {
      if (!other.observation || other.id == target.id) continue;
      const Observation<D>& point = detected[*other.observation];
      const double distance = (point.value - target.filter.position()).norm();
      const double reach = 0.5 * (likelihood.width_of(point) + target.width);
      if (distance < reach && distance < nearest) {
        nearest = distance;
        target.covered_by = other.observation;
      }
    }
  }
}

/// Targets that are expected, or were just seen, within a marker's width and a half of another.
template <int D>
void RosterEncounters<D>::mark_crowded(std::span<Target> targets) {
  locations_.clear();
  double widest = 0;
  for (const Target& target : targets) {
    locations_.push_back(target.filter.position());
    widest = std::max(widest, target.width);
  }
  const auto crowd = [&](int a, int b) {
    if (a == b || (locations_[a] - locations_[b]).norm() > kCrowded * 0.5 * (targets[a].width + targets[b].width)) return;
    targets[a].crowded = targets[b].crowded = true;
  };
  if (targets.size() <= kFewTargets) {
    for (int a = 0; a < std::ssize(targets); ++a) {
      for (int b = 0; b < a; ++b) crowd(a, b);
    }
    return;
  }
  grid_.build(locations_, kCrowded * widest);
  for (int a = 0; a < std::ssize(targets); ++a) {
    grid_.for_each_near(locations_[a], kCrowded * widest, [&](int b) { crowd(a, b); });
  }
}

template class RosterEncounters<2>;
template class RosterEncounters<3>;

}  // namespace marey::track::roster
