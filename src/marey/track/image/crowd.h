#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "marey/assign/point_grid.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/track/image/target.h"

namespace marey::track::image {

/// Which targets overlap in the image: which crowd each other, which hide behind others, and which have merged into one region.
class Crowd {
 public:
  /// A target whose box meets another's may be seen in part, or as one with it: its size then says less. Comes first in a frame;
  /// the other functions see the targets where they are now.
  void mark_crowded(std::span<Target> targets);

  /// What happens to a target that is held in a region together with others: moved at once, so that the next region finds it there.
  using Hold = std::function<void(Target& target, const Observation<2>& region)>;

  /// A region over several targets is those targets, merged, whether one of them is matched with it or none. Marks it in `merged`,
  /// one entry an observation, and calls `hold` for each confirmed target that is not matched and lies within it.
  void find_merged(std::span<Target> targets, std::span<const Observation<2>> detected, std::vector<char>& merged,
                   const Hold& hold);

  /// A target that is not seen is hidden where another target, or the region that one was seen in, covers it.
  void mark_hidden(std::span<Target> targets, std::span<const Observation<2>> detected) const;

  /// The largest unit of a target with a size; 0 if there is no such target.
  double widest() const { return widest_; }

 private:
  static Box box_of(const Target& target) { return target.size->around(target.filter.position()); }
  void find_covered(std::span<const Target> targets, const Box& region);

  std::vector<Vector<2>> centres_;
  assign::PointGrid<2> neighbours_;
  double widest_ = 0;
  std::vector<int> covered_;
  std::vector<std::optional<int>> target_of_;  // of each observation
};

}  // namespace marey::track::image
