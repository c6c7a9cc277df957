#include "marey/track/roster_adoption.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace marey::track {
namespace {

constexpr double kGentleJump = 1;           // gates
constexpr double kUnknownReach = 3.5;       // standard deviations
constexpr double kMostMisfit = 4;           // variances
constexpr double kMostOfStayed = 12;        // the same for a newcomer that stays
constexpr double kStayed = 0.5;             // s
constexpr double kShortPath = 5;            // marker widths that a target without rigid neighbours may have gone astray
constexpr double kUnknown = 100;            // variances: targets that rigid neighbours identify go first
constexpr double kOnItsWay = 0.25;          // of the path of a target that is lost, by which it may have left it
constexpr double kTurned = 0.15;            // of them turn round or stop unseen
constexpr double kTogether = 7;             // the same of a newcomer and of its place, from which it is the target
constexpr double kBegun = 2;                // log-likelihood ratio against clutter of a newcomer that was seen again
constexpr double kReturns = 5;              // log-likelihood ratio against clutter from which one point brings a target back
constexpr double kLeastImprobable = 50;     // so that no cost is below 0
constexpr double kFar = 1e6;                // px
constexpr long kMostLostPairs = 1'000'000;  // glare: no target is searched for in it

}  // namespace

template <int D>
void RosterAdoption<D>::find_lost(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& taken,
                                  RosterLikelihood<D>& likelihood, const RigidNeighbours& neighbours) {
  lost_.clear();
  free_.clear();
  for (int i = 0; i < std::ssize(targets); ++i) {
    if (targets[i].missed() && targets[i].standing == Target::Standing::established) lost_.push_back(i);
  }
  for (int i = 0; i < std::ssize(seen); ++i) {
    if (!taken[i]) free_.push_back(i);
  }
  likelihood.count_unexplained(std::max<double>(0, static_cast<double>(free_.size()) - static_cast<double>(lost_.size())));
  if (lost_.empty()) return;
  adopt_points(targets, seen, taken, likelihood, neighbours);
  adopt_newcomers(targets, likelihood, neighbours);
}

/// How far a target's own motion leaves it from a place; where it turned or stopped unseen, its last place is the better guess.
template <int D>
double RosterAdoption<D>::path_to(const Target& target, const Vector<D>& place) const {
  if (target.predicted_variance > 0) return (place - target.filter.position()).norm();
  return std::min((place - target.filter.position()).norm(), (place - target.last_place).norm());
}

/// Of a lost target at a place, as a logarithm: it most likely went on as it did, or nearly; it may have turned round or stopped;
/// and nothing is impossible.
template <int D>
double RosterAdoption<D>::log_density(const Target& target, const Vector<D>& place) const {
  const double speed = target.filter.velocity().norm();
  const auto density = [](double distance, double scale) {
    const double r = distance / scale;
    return std::pow(scale, -D) * std::pow(1 + r * r, -0.5 * (D + 1)) / (2 * std::numbers::pi);
  };
  const double on = density((place - target.filter.position()).norm(), target.width + kOnItsWay * speed * target.unseen);
  const double back = density((place - target.last_place).norm(), target.width + speed * target.unseen);
  return std::log((1 - kTurned) * on + kTurned * back);
}

/// What it costs to believe that a target that was lost is at a place; nothing where it cannot be. Where enough of its rigid
/// neighbours are seen, their misfit decides; else the path. Less is asked of a newcomer that has `stayed` there for a while: some
/// target it must be.
template <int D>
std::optional<double> RosterAdoption<D>::cost(const Target& target, const Vector<D>& place, const RigidNeighbours& neighbours,
                                              bool stayed) const {
  if constexpr (D == 3) {
    if (target.neighbour) {
      if (const auto misfit = neighbours.misfit(*target.neighbour, place)) {
        return *misfit < (stayed ? kMostOfStayed : kMostMisfit) ? misfit : std::nullopt;
      }
    }
  }
  const bool jumps = !options_.rigid_neighbours || stayed;
  if (!jumps && target.predicted_variance > 0) return std::nullopt;  // the search area has been looked through
  if (!jumps) {  // a target that is not known yet does not jump onto what may be its neighbour's
    const double reach = kUnknownReach * std::sqrt(target.filter.covariance().trace() / D) + target.width / 2;
    if ((place - target.filter.position()).norm() > reach) return std::nullopt;
    return kUnknown + path_to(target, place);
  }
  if ((place - target.last_place).norm() > options_.max_speed * target.unseen + target.width) return std::nullopt;
  if (options_.rigid_neighbours && path_to(target, place) > kShortPath * target.width) return std::nullopt;
  if (options_.rigid_neighbours) return kUnknown + path_to(target, place);
  return std::max(0.0, kLeastImprobable - log_density(target, place));
}

template <int D>
void RosterAdoption<D>::adopt_points(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& taken,
                                     const RosterLikelihood<D>& likelihood, const RigidNeighbours& neighbours) {
  if (free_.empty() || std::ssize(lost_) * std::ssize(free_) > kMostLostPairs) return;
  pairs_.clear();
  for (int row = 0; row < std::ssize(lost_); ++row) {
    const Target& target = targets[lost_[row]];
    for (int column = 0; column < std::ssize(free_); ++column) {
      const Vector<D>& place = seen[free_[column]].value;
      const auto price = cost(target, place, neighbours, false);
      if (!price || !likelihood.alike(target, seen[free_[column]])) continue;
      if (!likelihood.believes_jump(path_to(target, place) + target.width)) continue;
      if (likelihood.cluttered() && likelihood.log_return(log_density(target, place)) < kReturns) continue;
      pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
    }
  }
  const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(free_.size()), pairs_);
  for (int row = 0; row < std::ssize(lost_); ++row) {
    if (columns[row] == assign::kNoIndex) continue;
    const int index = free_[columns[row]];
    begin_anew(targets[lost_[row]], seen[index].value, likelihood.noise_of(seen[index]));
    targets[lost_[row]].observation = index;
    taken[index] = 1;
  }
}

/// The motion before the jump says little of the motion after it; half of the velocity seen since is kept for the start.
template <int D>
void RosterAdoption<D>::begin_anew(Target& target, const Vector<D>& place, const Matrix<D>& R) const {
  const double jump = (place - target.filter.position()).norm();
  if (target.filter.gate_distance(place, R) <= kGentleJump || jump < target.width) return;
  filter::AnyFilter<D> fresh(options_.filter, target.last_place, R);
  fresh.predict(target.unseen);
  if (fresh.gate_distance(place, R) > 1) fresh = filter::AnyFilter<D>(options_.filter, place, R);
  target.filter = std::move(fresh);
}

/// A newcomer that has stayed is one of the targets that are missed.
template <int D>
void RosterAdoption<D>::adopt_newcomers(std::span<Target> targets, const RosterLikelihood<D>& likelihood,
                                        const RigidNeighbours& neighbours) {
  pairs_.clear();
  proven_.clear();
  for (int i = 0; i < std::ssize(targets); ++i) {
    const Target& newcomer = targets[i];
    const bool shown = newcomer.score >= (likelihood.cluttered() ? kBegun : options_.confirm);
    if (!newcomer.on_roster() && newcomer.observation && shown) proven_.push_back(i);
  }
  for (int row = 0; row < std::ssize(lost_); ++row) {
    const Target& target = targets[lost_[row]];
    if (target.observation) continue;
    for (const int column : proven_) {
      const Target& newcomer = targets[column];
      if (likelihood.cluttered()) {  // that it stays, and that it is where the target may be, prove it together
        const double there = likelihood.log_return(log_density(target, newcomer.last_place));
        if (newcomer.score + there < kTogether) continue;
      }
      const auto price = cost(target, newcomer.last_place, neighbours, options_.rigid_neighbours && newcomer.seen > kStayed);
      if (price) pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
    }
  }
  if (pairs_.empty()) return;
  const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(targets.size()), pairs_);
  for (int row = 0; row < std::ssize(lost_); ++row) {
    if (columns[row] == assign::kNoIndex) continue;
    Target& target = targets[lost_[row]];
    Target& newcomer = targets[columns[row]];
    target.filter = newcomer.filter;
    target.observation = newcomer.observation;
    newcomer.observation.reset();
  }
}

template class RosterAdoption<2>;
template class RosterAdoption<3>;

}  // namespace marey::track
