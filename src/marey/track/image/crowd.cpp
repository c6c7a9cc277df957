#include "marey/track/image/crowd.h"

#include <algorithm>

namespace marey::track::image {
namespace {

constexpr double kCrowdedFraction = 0.2;  // of a box that another target's covers
constexpr double kMergedFraction = 0.6;   // of a box that lies within a region
constexpr double kMergedGrowth = 1.15;    // of a side, from which on a region is more than its target
constexpr double kCoveredFraction = 0.5;  // of a box behind another, from which on it is hidden

bool outgrows(const Box& region, const Target& target) {
  return target.size &&
         (region.width > kMergedGrowth * target.size->width() || region.height > kMergedGrowth * target.size->height());
}

}  // namespace

void Crowd::mark_crowded(std::span<Target> targets) {
  centres_.clear();
  widest_ = 0;
  for (Target& target : targets) {
    target.crowded = false;
    centres_.push_back(target.filter.position());
    if (target.size) widest_ = std::max(widest_, target.unit);
  }
  if (widest_ <= 0) return;
  neighbours_.build(centres_, widest_);
  for (Target& target : targets) {
    if (!target.size) continue;
    const Box box = box_of(target);
    neighbours_.for_each_near(target.filter.position(), (target.unit + widest_) / 2, [&](int index) {
      const Target& other = targets[index];
      if (other.id == target.id || !other.size || target.crowded) return;
      target.crowded = geometry::intersection(box, box_of(other)).area() > kCrowdedFraction * box.area();
    });
  }
}

void Crowd::find_merged(std::span<Target> targets, std::span<const Observation<2>> detected, std::vector<char>& merged,
                        const Hold& hold) {
  if (widest_ <= 0) return;
  target_of_.assign(detected.size(), std::nullopt);
  for (int i = 0; i < std::ssize(targets); ++i) {
    if (targets[i].observation) target_of_[*targets[i].observation] = i;
  }
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (!detected[i].box || detected[i].box->empty()) continue;
    if (target_of_[i] && !outgrows(*detected[i].box, targets[*target_of_[i]])) continue;
    find_covered(targets, *detected[i].box);
    if (covered_.size() + (target_of_[i] ? 1 : 0) < 2) continue;
    merged[i] = 1;
    for (const int index : covered_) hold(targets[index], detected[i]);
  }
}

void Crowd::mark_hidden(std::span<Target> targets, std::span<const Observation<2>> detected) const {
  for (Target& target : targets) {
    if (target.observation || !target.size) continue;
    const Box box = box_of(target);
    const auto covers = [&](const Box& other) { return geometry::intersection(box, other).area() > kCoveredFraction * box.area(); };
    neighbours_.for_each_near(target.filter.position(), target.unit / 2 + widest_, [&](int index) {
      const Target& other = targets[index];
      if (target.hidden || !other.observation || !other.size) return;
      const std::optional<Box>& region = detected[*other.observation].box;
      target.hidden = covers(box_of(other)) || (region && covers(*region));
    });
  }
}

/// Confirmed targets that are not seen and lie within the region for the most part, into `covered_`.
void Crowd::find_covered(std::span<const Target> targets, const Box& region) {
  covered_.clear();
  const double reach = std::max(region.width, region.height) / 2 + widest_;
  neighbours_.for_each_near(region.centre(), reach, [&](int index) {
    const Target& target = targets[index];
    if (!target.confirmed() || target.observation || !target.size) return;
    const Box box = box_of(target);
    if (geometry::intersection(box, region).area() > kMergedFraction * box.area()) covered_.push_back(index);
  });
  std::sort(covered_.begin(), covered_.end());
}

}  // namespace marey::track::image
