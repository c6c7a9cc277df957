#include "marey/track/image/reidentification.h"

#include <algorithm>

namespace marey::track::image {
namespace {

constexpr double kWithin = 0.3;  // sizes: this far from where it is expected,
constexpr double kSpeed = 0.5;   // sizes/s: and so much farther for each second

/// 0 where it is too far from where the target is expected, by its filter or by how it moved while all of it was seen.
double nearness(const Target& target, const Vector<2>& place, Timestamp now) {
  const double farthest = target.unit * (kWithin + kSpeed * seconds(now - target.last_seen));
  double distance = (place - target.filter.position()).norm();
  if (const auto ahead = target.unoccluded_motion.position_at(now)) distance = std::min(distance, (place - *ahead).norm());
  return distance > farthest ? 0 : 1 + farthest - distance;
}

}  // namespace

Vector<2> place_in(const Box& box, const Target& target, const BoxSizeOptions& sizes) {
  return target.size ? target.size->centre_in(box, target.filter.position(), sizes) : box.centre();
}

void Reidentification::match(std::span<Target> targets, std::span<const Observation<2>> seen, Timestamp now, const Limits& limits) {
  taken_.assign(seen.size(), 0);
  for (const Target& target : targets) {
    if (target.observation) taken_[*target.observation] = 1;
  }
  pairs_.clear();
  for (int row = 0; row < std::ssize(targets); ++row) {
    const Target& target = targets[row];
    if (!target.confirmed() || target.observation || target.hidden || !target.size) continue;
    for (int i = 0; i < std::ssize(seen); ++i) {
      const Observation<2>& one = seen[i];
      if (taken_[i] || !one.box || one.shared || one.score < limits.least_score) continue;
      if (target.size->distance(*one.box, limits.sizes) > limits.gate) continue;
      const Vector<2> place = one.box->empty() ? one.value : place_in(*one.box, target, limits.sizes);
      const double worth = nearness(target, place, now);
      if (worth > 0) pairs_.push_back({row, i, worth});
    }
  }
  if (pairs_.empty()) return;
  const auto columns = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(seen.size()), pairs_);
  for (int row = 0; row < std::ssize(targets); ++row) {
    if (columns[row] != assign::kNoIndex) targets[row].observation = columns[row];
  }
}

}  // namespace marey::track::image
