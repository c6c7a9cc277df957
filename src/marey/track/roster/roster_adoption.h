// The step that brings back lost markers: targets that are missed and points that match none are brought together within the reach
// of the greatest speed, at once where false points are rare; else once the point has proved, as a newcomer, that it stays. Of all
// pairs within reach the assignment with the shortest paths wins. In space, where rigid neighbours distinguish markers, a pair is
// only trusted where no other explains the point, or the target, nearly as well: else the point continues as a newcomer, until its
// distances say which of them it is. Cost: lost × unmatched.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/track/roster/roster_rigid_neighbours.h"
#include "marey/track/roster/roster_target.h"

namespace marey::track::roster {

/// D = 2 or 3.
template <int D>
class RosterAdoption {
 public:
  using Target = RosterTarget<D>;

  explicit RosterAdoption(const RosterTrackerOptions& options) : options_(options) {}

  /// Gives targets that are missed the observations that they are thought to be, and marks these in `taken`, one entry a point.
  void find_lost(std::span<Target> targets, std::span<const Observation<D>> detected, std::vector<char>& taken,
                 RosterLikelihood<D>& likelihood, RosterRigidNeighbours<D>& neighbours);

 private:
  using Neighbours = RosterRigidNeighbours<D>;

  void notice_jolt(std::span<const Target> targets);
  bool rotated_to(const Target& target, const Vector<D>& location) const;
  double path_to(const Target& target, const Vector<D>& location) const;
  double log_density(const Target& target, const Vector<D>& location) const;
  std::optional<double> cost(const Target& target, const Vector<D>& location, const Neighbours& neighbours,
                             const Target* newcomer) const;
  void adopt_points(std::span<Target> targets, std::span<const Observation<D>> detected, std::vector<char>& taken,
                    const RosterLikelihood<D>& likelihood, const Neighbours& neighbours);
  void restart(Target& target, const Vector<D>& location, const Matrix<D>& R) const;
  void adopt_newcomers(std::span<Target> targets, const RosterLikelihood<D>& likelihood, Neighbours& neighbours);
  void assign(int rows, int columns);
  bool leaves_ambiguity(int row) const;

  RosterTrackerOptions options_;
  double dt_ = 0;          // s since the frame before
  double since_jolt_ = 0;  // s since many targets were missed at once, and a frame; 0: that is long ago
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> lost_, free_, proven_;
  std::vector<assign::GatedPair> pairs_;
  std::vector<int> columns_;  // by row: the column that it is given, or none
  assign::GatedAssigner assigner_;
};

extern template class RosterAdoption<2>;
extern template class RosterAdoption<3>;

}  // namespace marey::track::roster
