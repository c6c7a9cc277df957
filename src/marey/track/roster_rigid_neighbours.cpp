#include "marey/track/roster_rigid_neighbours.h"

#include <optional>
#include <utility>

namespace marey::track {
namespace {

constexpr double kAstray = 5;       // marker widths that a lost target without known neighbours may have gone astray
constexpr double kFollowed = 0.04;  // of the variance of the neighbours' prediction, when it is followed
constexpr double kEnrolled = 0.2;   // s after which a target is one of the neighbours
constexpr double kForeign = 9;      // variances of its distances from which its neighbours contradict a target
constexpr int kMostMisfits = 8;     // frames that they do

}  // namespace

template <int D>
void RosterRigidNeighbours<D>::check_followed(std::span<Target> targets, std::span<const Observation<D>> seen,
                                              std::vector<char>& taken) {
  if constexpr (D == 3) {
    neighbours_.begin_frame();
    for (const Target& target : targets) {
      if (target.neighbour && target.observation) neighbours_.see(*target.neighbour, seen[*target.observation].value);
    }
    for (Target& target : targets) {
      if (!target.neighbour || !target.observation) continue;
      const auto misfit = neighbours_.misfit(*target.neighbour, seen[*target.observation].value);
      target.misfits = misfit && *misfit > kForeign ? target.misfits + 1 : 0;
      if (target.misfits < kMostMisfits) continue;
      target.misfits = 0;
      taken[*target.observation] = 0;
      target.observation.reset();
      target.predicted_variance = 0;
      neighbours_.disown(*target.neighbour);
    }
  }
}

template <int D>
bool RosterRigidNeighbours<D>::agree(const Target& target, const Vector<D>& place, double dt) const {
  if constexpr (D == 3) {
    if (!used() || target.unseen < 1.5 * dt) return true;
    const auto misfit = target.neighbour ? neighbours_.misfit(*target.neighbour, place) : std::nullopt;
    if (misfit) return *misfit < kForeign;
    return (place - target.filter.position()).norm() < kAstray * target.width;
  }
  return true;
}

template <int D>
void RosterRigidNeighbours<D>::learn(std::vector<Target>& targets) {
  if constexpr (D == 3) {
    if (!used()) return;
    for (Target& target : targets) {
      if (target.standing != Standing::established || !target.observation) continue;
      if (!target.neighbour && target.seen > kEnrolled) target.neighbour = neighbours_.enrol();
      if (target.neighbour) neighbours_.see(*target.neighbour, target.last_place);
    }
    neighbours_.end_frame();
    merge_doubles(targets);
    for (Target& target : targets) predict_unseen(target);
  }
}

/// A target that this frame does not see is where its rigid neighbours went.
template <int D>
void RosterRigidNeighbours<D>::predict_unseen(Target& target) {
  target.predicted_variance = 0;
  if constexpr (D == 3) {
    if (!target.neighbour || target.observation) return;
    const auto place = neighbours_.place_of(*target.neighbour);
    if (!place) return;
    // Followed closely: how unsure the place is, `predicted_variance` says.
    target.filter.correct(place->position, Matrix<D>::Identity() * (kFollowed * place->variance));
    target.predicted_variance = place->variance;
  }
}

/// A marker that was given a second name while it was lost gets its first one back.
template <int D>
void RosterRigidNeighbours<D>::merge_doubles(std::vector<Target>& targets) {
  std::optional<TrackId> doubled;
  for (Target& lost : targets) {
    if (!lost.neighbour || lost.observation) continue;
    for (Target& other : targets) {
      if (!other.neighbour || !other.observation || other.id < lost.id || !other.label.empty()) continue;
      if (!neighbours_.same(*lost.neighbour, *other.neighbour)) continue;
      std::swap(lost.filter, other.filter);
      std::swap(lost.observation, other.observation);
      std::swap(lost.last_place, other.last_place);
      std::swap(lost.unseen, other.unseen);
      if constexpr (D == 3) neighbours_.see(*lost.neighbour, lost.last_place);
      doubled = other.id;
      break;
    }
  }
  if (doubled) std::erase_if(targets, [&](const Target& target) { return target.id == *doubled; });
}

template class RosterRigidNeighbours<2>;
template class RosterRigidNeighbours<3>;

}  // namespace marey::track
