// The step that gives points to the targets that are expected near them: the assignment that is globally the likeliest, of points
// within the search areas. Cost: near linear in targets + points while search areas hold few points.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/point_grid.h"
#include "marey/track/roster/roster_rigid_neighbours.h"
#include "marey/track/roster/roster_target.h"

namespace marey::track::roster {

/// D = 2 or 3.
template <int D>
class RosterMatching {
 public:
  using Target = RosterTarget<D>;

  explicit RosterMatching(const RosterTrackerOptions& options) : options_(options) {}

  /// Gives the points that are not `taken`, one entry a point, to those of the targets that are `wanted`, one entry a target. `dt`
  /// is what passed since the frame before, s.
  void match(std::span<Target> targets, std::span<const char> required, std::span<const Observation<D>> detected,
             std::vector<char>& taken, double dt, const RosterLikelihood<D>& likelihood,
             const RosterRigidNeighbours<D>& neighbours);

 private:
  /// What bounds every observation's covariance in a frame.
  struct Spread {
    double variance = 0;
    double narrowest = 0, widest = 0;  // marker
  };

  Spread spread_of(std::span<const Observation<D>> detected, const RosterLikelihood<D>& likelihood) const;
  double reach_of(const Target& target, const Spread& spread) const;
  double search_radius(const Target& target) const;
  double gain(const Target& target, const Observation<D>& point, double dt, const RosterLikelihood<D>& likelihood) const;

  RosterTrackerOptions options_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<Vector<D>> points_;
  std::vector<assign::GatedPair> pairs_;
  assign::PointGrid<D> grid_;
  assign::GatedAssigner assigner_;
};

extern template class RosterMatching<2>;
extern template class RosterMatching<3>;

}  // namespace marey::track::roster
