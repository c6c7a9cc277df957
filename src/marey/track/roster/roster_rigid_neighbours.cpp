#include "marey/track/roster/roster_rigid_neighbours.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace marey::track::roster {
namespace {

constexpr double kBriefly = 0.15;    // s in which its own motion still says where it is
constexpr double kFollowed = 0.04;   // of the variance of the neighbours' prediction, when it is followed
constexpr double kEnrolled = 0.1;    // s after which a target is one of the neighbours
constexpr double kForeign = 9;       // variances of its distances from which its neighbours contradict a target
constexpr int kMostMisfits = 8;      // frames that they do
constexpr double kComesBackAt = 4;   // variances of its distances at which a lost target is believed to be back
constexpr double kRival = 4;         // variances by which no other target that is lost fits as well
constexpr double kSameMarker = 1.5;  // variances between distances of one marker under two names
constexpr double kOtherMarker = 6;   // and of two markers

}  // namespace

template <int D>
void RosterRigidNeighbours<D>::check_followed(std::span<Target> targets, std::span<const Observation<D>> seen,
                                              std::vector<char>& taken, Timestamp now) {
  renamed_.clear();
  freed_.clear();
  if constexpr (D == 3) {
    neighbours_.begin_frame();
    for (const Target& target : targets) {
      if (target.neighbour && target.observation) neighbours_.see(*target.neighbour, seen[*target.observation].value);
    }
    for (Target& target : targets) {
      if (!target.neighbour || !target.observation) continue;
      const auto misfit = neighbours_.misfit(*target.neighbour, seen[*target.observation].value);
      target.misfits = misfit && *misfit > kForeign ? target.misfits + 1 : 0;
      if (misfit && target.misfits == 0) target.sure_until = now;
      if (target.misfits < kMostMisfits) continue;
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
bool RosterRigidNeighbours<D>::agree(std::span<const Target> targets, int index, const Vector<D>& place, double dt) const {
  if constexpr (D == 3) {
    const Target& target = targets[static_cast<std::size_t>(index)];
    if (!used() || target.unseen < 1.5 * dt) return true;
    if (!target.near(place)) return false;
    const auto own = misfit(target, place);
    if (own ? *own > kComesBackAt : target.unseen > kBriefly) return false;
    return std::none_of(targets.begin(), targets.end(), [&](const Target& other) {
      if (&other == &target || !other.missed() || other.unseen < 1.5 * dt || !other.near(place)) return false;
      const auto others = misfit(other, place);
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
      if (!target.neighbour && target.seen > kEnrolled) target.neighbour = neighbours_.enrol();
      if (target.neighbour) neighbours_.see(*target.neighbour, target.last_place);
    }
    neighbours_.end_frame(dt);
    name_newcomers(targets);
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
    if (!place || 3 * place->variance > target.filter.covariance().trace()) return;  // its own motion says more
    // Followed closely: how unsure the place is, `predicted_variance` says.
    target.filter.correct(place->position, Matrix<D>::Identity() * (kFollowed * place->variance));
    target.predicted_variance = place->variance;
  }
}

template <int D>
void RosterRigidNeighbours<D>::adopt(Target& lost, Target& newcomer) {
  if (!used()) return;
  renamed_.push_back({newcomer.id, lost.id, newcomer.since});
  lost.since = newcomer.since;
  lost.unseen = newcomer.unseen;
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
  double least = std::numeric_limits<double>::infinity(), second = least;
  for (Target& lost : targets) {
    if (!lost.neighbour || lost.observation || lost.id > newcomer.id) continue;
    const auto difference = neighbours_.difference(*lost.neighbour, *newcomer.neighbour);
    if (!difference) continue;
    if (*difference < least) {
      second = std::exchange(least, *difference);
      best = &lost;
    } else {
      second = std::min(second, *difference);
    }
  }
  return least < kSameMarker && second > kOtherMarker ? best : nullptr;
}

/// A marker that was given a new name while it was lost gets its first one back, once its distances prove it. One newcomer a frame
/// is looked at.
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
  std::swap(lost->last_place, newcomer->last_place);
  if constexpr (D == 3) {
    adopt(*lost, *newcomer);
    neighbours_.see(*lost->neighbour, lost->last_place);
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
