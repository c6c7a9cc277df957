#pragma once

#include <span>
#include <vector>

#include "marey/track/rigid_neighbours.h"
#include "marey/track/roster_target.h"

namespace marey::track {

/// What the roster tracker asks of the markers that move together rigidly: in space, and where the options say so. D = 2 or 3.
template <int D>
class RosterRigidNeighbours {
 public:
  using Target = RosterTarget<D>;

  explicit RosterRigidNeighbours(const RosterTrackerOptions& options) : used_(D == 3 && options.rigid_neighbours) {}

  bool used() const { return used_; }
  const RigidNeighbours& all() const { return neighbours_; }

  /// Shows the targets that are followed without a break to the others of this frame. One that these contradict, frame after frame,
  /// is lost: its observation, marked in `taken`, is free again.
  void check_followed(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& taken);

  /// Whether its rigid neighbours have nothing against it that a target that was lost is at a place.
  bool agree(const Target& target, const Vector<D>& place, double dt) const;

  /// Learns from established targets that are seen how markers move together, and predicts those that are not seen.
  void learn(std::vector<Target>& targets);

 private:
  using Standing = typename Target::Standing;

  void predict_unseen(Target& target);
  void merge_doubles(std::vector<Target>& targets);

  bool used_;
  RigidNeighbours neighbours_;
};

extern template class RosterRigidNeighbours<2>;
extern template class RosterRigidNeighbours<3>;

}  // namespace marey::track
