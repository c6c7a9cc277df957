#include "marey/track/image/reidentification.h"

#include <algorithm>

namespace marey::track::image {
namespace {

constexpr double kWithin = 0.3;  // sizes: this far from where it is expected,
constexpr double kSpeed = 0.5;   // sizes/s: and this much farther for each second

/// 0 where it is too far from where the target is expected, by its filter or by how it moved while all of it was seen.
double nearness(const Target& target, const Vector<2>& location, Timestamp now) {
  const double farthest = target.unit * (kWithin + kSpeed * seconds(now - target.last_observed));
  double distance = (location - target.filter.position()).norm();
  if (const auto ahead = target.unoccluded_motion.position_at(now)) distance = std::min(distance, (location - *ahead).norm());
  return distance > farthest ? 0 : 1 + farthest - distance;
}

}  // namespace

Vector<2> position_in(const Box& box, const Target& target, const BoxSizeOptions& sizes) {
  return target.size ? target.size->centre_in(box, target.filter.position(), sizes) : box.centre();
}

void Reidentification::match(std::span<Target> targets, std::span<const Observation<2>> detected, Timestamp now,
                             const Limits& limits) {
  taken_.assign(detected.size(), 0);
  for (const Target& target : targets) {
    if (target.observation) taken_[*target.observation] = 1;
  }
  pairs_.clear();
  for (int row = 0; row < std::ssize(targets); ++row) {
    const Target& target = targets[row];
    if (!target.confirmed() || target.observation || target.hidden || !target.size) continue;
    for (int i = 0; i < std::ssize(detected); ++i) {
      const Observation<2>& one = detected[i];
      if (taken_[i] || !one.box || one.shared || one.score < limits.min_score) continue;
      if (target.size->distance(*one.box, limits.sizes) > limits.gate) continue;
      const Vector<2> location = one.box->empty() ? one.value : position_in(*one.box, target, limits.sizes);
      const double merit = nearness(target, location, now);
      if (merit > 0) pairs_.push_back({row, i, merit});
    }
  }
  if (pairs_.empty()) return;
  const auto columns = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(detected.size()), pairs_);
  for (int row = 0; row < std::ssize(targets); ++row) {
    if (columns[row] != assign::kNoIndex) targets[row].observation = columns[row];
  }
}

}  // namespace marey::track::image
