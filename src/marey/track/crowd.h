#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marey/assign/point_grid.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/track/target.h"

namespace marey::track {

/// Who is near whom in the image: which targets crowd each other, which hide behind others, and which have merged into one region.
/// Makes sense of targets with a size in the image only. `camera` is by how far the camera has moved the picture.
template <typename F>
class Crowd {
 public:
  /// A target whose box meets another's may be seen in part, or as one with it: its size then says less. Comes first in a frame;
  /// the other functions see the targets where they are now.
  void mark_crowded(std::span<Target<F>> targets, const Vector<2>& camera) {
    camera_ = camera;
    centres_.clear();
    widest_ = 0;
    for (Target<F>& target : targets) {
      target.crowded = false;
      centres_.push_back(in_view(target));
      if (target.size) widest_ = std::max(widest_, target.unit);
    }
    if (widest_ <= 0) return;
    neighbours_.build(centres_, widest_);
    for (Target<F>& target : targets) {
      if (!target.size) continue;
      const Box box = box_of(target);
      neighbours_.for_each_near(in_view(target), (target.unit + widest_) / 2, [&](int index) {
        const Target<F>& other = targets[index];
        if (other.id == target.id || !other.size || target.crowded) return;
        target.crowded = geometry::intersection(box, box_of(other)).area() > crowded_share * box.area();
      });
    }
  }

  /// A region over several targets is those targets, merged, whether one of them claims it or none. Marks it in `merged`, one entry
  /// an observation, and calls held(target, observation) for each confirmed target that nobody else has seen within it.
  template <typename Held>
  void find_merged(std::span<Target<F>> targets, std::span<const Observation<2>> seen, std::vector<char>& merged, Held&& held) {
    if (widest_ <= 0) return;
    claimant_.assign(seen.size(), -1);
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
      if (targets[i].observation >= 0) claimant_[targets[i].observation] = i;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i].box || seen[i].box->empty()) continue;
      if (claimant_[i] >= 0 && !outgrows(*seen[i].box, targets[claimant_[i]])) continue;
      find_covered(targets, *seen[i].box);
      if (covered_.size() + (claimant_[i] >= 0 ? 1 : 0) < 2) continue;
      merged[i] = 1;
      for (const int index : covered_) held(targets[index], seen[i]);
    }
  }

  /// A target that is not seen is hidden where another target, or the region that one was seen in, covers it.
  void mark_hidden(std::span<Target<F>> targets, std::span<const Observation<2>> seen) {
    for (Target<F>& target : targets) {
      if (target.observation >= 0 || !target.size) continue;
      const Box box = box_of(target);
      const auto covers = [&](const Box& other) { return geometry::intersection(box, other).area() > covered_share * box.area(); };
      neighbours_.for_each_near(in_view(target), target.unit / 2 + widest_, [&](int index) {
        const Target<F>& other = targets[index];
        if (target.hidden || other.observation < 0 || !other.size) return;
        const std::optional<Box>& region = seen[other.observation].box;
        target.hidden = covers(box_of(other)) || (region && covers(*region));
      });
    }
  }

  /// The largest unit of a target with a size; 0 where there is none.
  double widest() const { return widest_; }

 private:
  Vector<2> in_view(const Target<F>& target) const { return target.filter.position() + camera_; }
  Box box_of(const Target<F>& target) const { return target.size->around(in_view(target)); }

  static bool outgrows(const Box& region, const Target<F>& target) {
    return target.size &&
           (region.width > merged_growth * target.size->width() || region.height > merged_growth * target.size->height());
  }

  /// Confirmed targets that are not seen and lie within the region for the most part, into `covered_`.
  void find_covered(std::span<const Target<F>> targets, const Box& region) {
    covered_.clear();
    const double reach = std::max(region.width, region.height) / 2 + widest_;
    neighbours_.for_each_near(region.centre(), reach, [&](int index) {
      const Target<F>& target = targets[index];
      if (!target.confirmed || target.observation >= 0 || !target.size) return;
      const Box box = box_of(target);
      if (geometry::intersection(box, region).area() > merged_share * box.area()) covered_.push_back(index);
    });
    std::sort(covered_.begin(), covered_.end());
  }

  static constexpr double crowded_share = 0.2;
  static constexpr double merged_share = 0.6;
  static constexpr double merged_growth = 1.15;
  static constexpr double covered_share = 0.5;

  Vector<2> camera_ = Vector<2>::Zero();
  std::vector<Vector<2>> centres_;
  assign::PointGrid<2> neighbours_;
  double widest_ = 0;
  std::vector<int> covered_, claimant_;
};

}  // namespace marey::track
