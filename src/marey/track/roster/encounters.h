// The step for targets that meet: one without a point whose place is covered by another's point is taken to be behind it; while two
// are that close neither's velocity is trusted to the point they share, so that each comes out with the motion it went in with.
// Cost: near linear in targets.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/point_grid.h"
#include "marey/track/roster/roster_target.h"

namespace marey::track::roster {

/// D = 2 or 3.
template <int D>
class RosterEncounters {
 public:
  using Target = RosterTarget<D>;

  /// Marks targets that are `crowded`, and those that are `covered_by` another's point.
  void meet(std::span<Target> targets, std::span<const Observation<D>> detected, const RosterLikelihood<D>& likelihood);

 private:
  void mark_crowded(std::span<Target> targets);

  std::vector<Vector<D>> locations_;
  assign::PointGrid<D> grid_;
};

extern template class RosterEncounters<2>;
extern template class RosterEncounters<3>;

}  // namespace marey::track::roster
