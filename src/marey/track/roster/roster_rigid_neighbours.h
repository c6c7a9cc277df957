#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/track/roster/rigid_neighbours.h"
#include "marey/track/roster/roster_decisions.h"
#include "marey/track/roster/roster_target.h"

namespace marey::track::roster {

/// What the roster tracker asks of the markers that move together rigidly: in space, and where the options say so. D = 2 or 3.
template <int D>
class RosterRigidNeighbours {
 public:
  using Target = RosterTarget<D>;

  explicit RosterRigidNeighbours(const RosterTrackerOptions& options) : used_(D == 3 && options.rigid_neighbours) {}

  bool used() const { return used_; }

  /// How badly a place of this frame fits the distances that the target keeps; nothing if they are not known.
  std::optional<double> misfit(const Target& target, const Vector<D>& location) const {
    if constexpr (D == 3) {
      if (target.neighbour) return neighbours_.misfit(*target.neighbour, location);
    }
    return std::nullopt;
  }

  /// Shows the targets that are followed without a break to the others of this frame. One that these contradict, frame after frame,
  /// is lost: its observation, marked in `taken`, is free again.
  void check_tracked(std::span<Target> targets, std::span<const Observation<D>> detected, std::vector<char>& taken, Timestamp now);

  /// Whether its rigid neighbours have nothing against it that a target that was lost is at a place, and no other target that is
  /// lost fits there nearly as well.
  bool agree(std::span<const Target> targets, int index, const Vector<D>& location, double dt) const;

  /// Learns from targets that are seen how markers move together, finds out which newcomers are targets that were lost, and
  /// predicts those that are not seen.
  void learn(std::vector<Target>& targets, double dt);

  /// A newcomer proved to be a target that was lost, which takes its place: the data of both are one marker's.
  void adopt(Target& lost, Target& newcomer);
  /// A newcomer proved to be a target of its own.
  void confirm(const Target& target);
  /// The target is given up.
  void forget(const Target& target);

  /// What turned out of names in this frame. Valid until the next check_tracked.
  std::span<const RenamedTrack> renamed(std::span<const Target> targets);

 private:
  using Standing = typename Target::Standing;

  /// A point that was taken from a target in this frame, because it is another's.
  struct Freed {
    TrackId from{};
    Timestamp since{};
    int observation = 0;
  };

  void predict_unobserved(Target& target);
  void name_newcomers(std::vector<Target>& targets);
  Target* lost_one_that_is(std::span<Target> targets, const Target& newcomer);

  bool used_;
  std::size_t turn_ = 0;  // whose newcomer's name is searched for
  RigidNeighbours neighbours_;
  std::vector<Freed> freed_;
  std::vector<RenamedTrack> renamed_;
};

extern template class RosterRigidNeighbours<2>;
extern template class RosterRigidNeighbours<3>;

}  // namespace marey::track::roster
