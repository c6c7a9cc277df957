#include "marey/track/roster/roster_rigid_neighbours.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace marey::track::roster {
namespace {

constexpr double kTransiently = 0.15;  // s in which its own motion still says where it is
constexpr double kTracked = 0.04;      // of the variance of the neighbours' prediction, when it is followed
constexpr double kEnrolled = 0.1;      // s after which a target is one of the neighbours
constexpr double kForeign = 9;         // variances of its distances from which its neighbours contradict a target
constexpr int kMaxMisfits = 8;         // frames that they do
constexpr double kComesBackAt = 4;     // variances of its distances at which a lost target is trusted to be back
constexpr double kRival = 4;           // variances by which no other target that is lost fits as well
constexpr double kSameMarker = 1.5;    // variances between distances of one marker under two names
constexpr double kOtherMarker = 6;     // and of two markers

}  // namespace

template <int D>
void RosterRigidNeighbours<D>::check_tracked(std::span<Target> targets, std::span<const Observation<D>> detected,
                                             std::vector<char>& taken, Timestamp now) {
  renamed_.clear();
  freed_.clear();
  if constexpr (D == 3) {
    neighbours_.begin_frame();
    for (const Target& target : targets) {
      if (target.neighbour && target.observation) neighbours_.observe_frame(*target.neighbour, detected[*target.observation].value);
    }
    for (Target& target : targets) {
      if (!target.neighbour || !target.observation) continue;
      const auto misfit = neighbours_.misfit(*target.neighbour, detected[*target.observation].value);
      target.misfits = misfit && *misfit > kForeign ? target.misfits + 1 : 0;
      if (misfit && target.misfits == 0) target.sure_until = now;
      if (target.misfits < kMaxMisfits) continue;
      target.misfits = 0;
      freed_.push_back({target.id, std::max(target.since, target.sure_until), *target.observation});
      taken[*target.observation] = 0;
      target.observation.reset();
      target.predicted_variance = 0;
      neighbours_.disown(*target.neighbour);
    }
  }
}

template <int D>
bool RosterRigidNeighbours<D>::agree(std::span<const Target> targets, int index, const Vector<D>& location, double dt) const {
  if constexpr (D == 3) {
    const Target& target = targets[static_cast<std::size_t>(index)];
    if (!used() || target.unobserved < 1.5 * dt) return true;
    if (!target.near(location)) return false;
    const auto own = misfit(target, location);
    if (own ? *own > kComesBackAt : target.unobserved > kTransiently) return false;
    return std::none_of(targets.begin(), targets.end(), [&](const Target& other) {
      if (&other == &target || !other.missed() || other.unobserved < 1.5 * dt || !other.near(location)) return false;
      const auto others = misfit(other, location);
      return !own || (others && *others < *own + kRival);
    });
  }
  return true;
}

template <int D>
void RosterRigidNeighbours<D>::learn(std::vector<Target>& targets, double dt) {
  if constexpr (D == 3) {
    if (!used()) return;
    for (Target& target : targets) {
      if (!target.observation || target.misfits > 0) continue;
      if (!target.neighbour && target.detected > kEnrolled) target.neighbour = neighbours_.enrol();
      if (target.neighbour) neighbours_.observe_frame(*target.neighbour, target.last_position);
    }
    neighbours_.end_frame(dt);
    name_newcomers(targets);
    for (Target& target : targets) predict_unobserved(target);
  }
}

/// A target that this frame does not see is where its rigid neighbours went.
template <int D>
void RosterRigidNeighbours<D>::predict_unobserved(Target& target) {
  target.predicted_variance = 0;
  if constexpr (D == 3) {
    if (!target.neighbour || target.observation) return;
    const auto location = neighbours_.position_of(*target.neighbour);
    if (!location || 3 * location->variance > target.filter.covariance().trace()) return;  // its own motion says more
    // Followed closely: how unsure the place is, `predicted_variance` says.
    target.filter.correct(location->position, Matrix<D>::Identity() * (kTracked * location->variance));
    target.predicted_variance = location->variance;
  }
}

template <int D>
void RosterRigidNeighbours<D>::adopt(Target& lost, Target& newcomer) {
  if (!used()) return;
  renamed_.push_back({newcomer.id, lost.id, newcomer.since});
  lost.since = newcomer.since;
  lost.unobserved = newcomer.unobserved;
  if (!newcomer.neighbour) return;
  if (lost.neighbour) {
    neighbours_.merge(*newcomer.neighbour, *lost.neighbour);
  } else {
    lost.neighbour = newcomer.neighbour;
  }
  newcomer.neighbour.reset();
}

template <int D>
void RosterRigidNeighbours<D>::confirm(const Target& target) {
  if (used()) renamed_.push_back({target.id, target.id, target.since});
}

template <int D>
void RosterRigidNeighbours<D>::forget(const Target& target) {
  if (target.neighbour) neighbours_.release(*target.neighbour);
}

/// The one lost target whose distances are the newcomer's, if there is only one.
template <int D>
auto RosterRigidNeighbours<D>::lost_one_that_is(std::span<Target> targets, const Target& newcomer) -> Target* {
  Target* best = nullptr;
  double minimum = std::numeric_limits<double>::infinity(), second = minimum;
  for (Target& lost : targets) {
    if (!lost.neighbour || lost.observation || lost.id > newcomer.id) continue;
    const auto difference = neighbours_.difference(*lost.neighbour, *newcomer.neighbour);
    if (!difference) continue;
    if (*difference < minimum) {
      second = std::exchange(minimum, *difference);
      best = &lost;
    } else {
      second = std::min(second, *difference);
    }
  }
  return minimum < kSameMarker && second > kOtherMarker ? best : nullptr;
}

/// A marker that was given a new name while it was lost gets its first one back, once its distances prove it. One newcomer a frame
/// is inspected.
template <int D>
void RosterRigidNeighbours<D>::name_newcomers(std::vector<Target>& targets) {
  const auto is_new = [](const Target& target) { return target.neighbour && target.observation && target.may_be_another; };
  const auto count = static_cast<std::size_t>(std::count_if(targets.begin(), targets.end(), is_new));
  if (count == 0) return;
  std::size_t number = turn_++ % count;
  const auto newcomer = std::find_if(targets.begin(), targets.end(), [&](const Target& t) { return is_new(t) && number-- == 0; });
  Target* lost = lost_one_that_is(targets, *newcomer);
  if (lost == nullptr) return;
  const TrackId doubled = newcomer->id;
  std::swap(lost->filter, newcomer->filter);
  std::swap(lost->observation, newcomer->observation);
  std::swap(lost->last_position, newcomer->last_position);
  if constexpr (D == 3) {
    adopt(*lost, *newcomer);
    neighbours_.observe_frame(*lost->neighbour, lost->last_position);
  }
  std::erase_if(targets, [&](const Target& target) { return target.id == doubled; });
}

template <int D>
std::span<const RenamedTrack> RosterRigidNeighbours<D>::renamed(std::span<const Target> targets) {
  for (const Freed& freed : freed_) {
    for (const Target& target : targets) {
      if (target.observation == freed.observation) renamed_.push_back({freed.from, target.id, freed.since});
    }
  }
  return renamed_;
}

template class RosterRigidNeighbours<2>;
template class RosterRigidNeighbours<3>;

}  // namespace marey::track::roster
