#include "marey/track/roster/roster_adoption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace marey::track::roster {
namespace {

constexpr double kGentleJump = 1;          // gates
constexpr double kMaxMisfit = 4;           // variances
constexpr double kStayed = 0.1;            // s that a newcomer stays, before it may be a target that was lost
constexpr double kShortPath = 3;           // marker widths that a target without rigid neighbours may have gone astray
constexpr double kOwnMotion = 0.25;        // s in which a target's own motion still says where it is
constexpr double kJolted = 0.34;           // of the targets of the frame before that are missed at once: their motion turned
constexpr double kJoltLasts = 0.1;         // s in which they are then searched where they are if they turned
constexpr double kSteps = 0.25;            // marker widths, and of its path, that a place is uncertain by there
constexpr double kClear = 3;               // variances, or widths, by which a pair must be better than what else may be
constexpr double kNotPriced = 1e3;         // variances
constexpr double kUnknown = 100;           // variances: targets that rigid neighbours identify go first
constexpr double kEnRoute = 0.25;          // of the path of a target that is lost, by which it may have left it
constexpr double kRotated = 0.15;          // of them turn round or stop unseen
constexpr double kTogether = 7;            // the same of a newcomer and of its place, from which it is the target
constexpr double kBegun = 2;               // log-likelihood ratio against clutter of a newcomer that was seen again
constexpr double kReturns = 5;             // log-likelihood ratio against clutter from which one point brings a target back
constexpr double kMinImprobable = 50;      // so that no cost is below 0
constexpr double kFar = 1e6;               // px
constexpr long kMaxLostPairs = 1'000'000;  // glare: no target is searched for in it

}  // namespace

template <int D>
void RosterAdoption<D>::find_lost(std::span<Target> targets, std::span<const Observation<D>> detected, std::vector<char>& taken,
                                  RosterLikelihood<D>& likelihood, RosterRigidNeighbours<D>& neighbours) {
  lost_.clear();
  free_.clear();
  for (int i = 0; i < std::ssize(targets); ++i) {
    if (targets[i].missed() && targets[i].standing == Target::Standing::established) lost_.push_back(i);
  }
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (!taken[i]) free_.push_back(i);
  }
  notice_jolt(targets);
  likelihood.count_unexplained(std::max<double>(0, static_cast<double>(free_.size()) - static_cast<double>(lost_.size())));
  if (lost_.empty()) return;
  adopt_points(targets, detected, taken, likelihood, neighbours);
  adopt_newcomers(targets, likelihood, neighbours);
}

/// One target that is missed was covered; where many of those that were just seen are missed in one frame, something happened to
/// all of them: they turned back, hit something, or images are missing.
template <int D>
void RosterAdoption<D>::notice_jolt(std::span<const Target> targets) {
  if (!options_.rigid_neighbours) return;
  dt_ = std::numeric_limits<double>::infinity();
  for (const Target& target : targets) dt_ = std::min(dt_, target.unobserved);
  double seen_before = 0, missed = 0;
  for (const Target& target : targets) {
    if (target.standing != Target::Standing::established || target.unobserved > 1.5 * dt_) continue;
    ++seen_before;
    missed += target.missed();
  }
  if (missed > 0 && missed >= kJolted * seen_before) {
    since_jolt_ = 1.5 * dt_;
  } else if (since_jolt_ > 0) {
    since_jolt_ = since_jolt_ + dt_ < kJoltLasts ? since_jolt_ + dt_ : 0;
  }
}

/// Whether a target in space that was just seen would be at a place had it turned: one alone only on the path it came, for what
/// appears elsewhere may be another.
template <int D>
bool RosterAdoption<D>::rotated_to(const Target& target, const Vector<D>& location) const {
  const double slack = kSteps * target.width;
  if (target.unobserved < since_jolt_) return target.within_reach(location, slack);
  if (target.unobserved > 1.5 * dt_) return false;
  const Vector<D> back = target.last_position - target.unobserved * target.filter.velocity();
  return (location - back).norm() <= slack + kSteps * target.unobserved * target.filter.velocity().norm();
}

/// How far a target's own motion leaves it from a place; where it turned or stopped unseen, its last place is the better guess.
template <int D>
double RosterAdoption<D>::path_to(const Target& target, const Vector<D>& location) const {
  if (target.predicted_variance > 0) return (location - target.filter.position()).norm();
  return std::min((location - target.filter.position()).norm(), (location - target.last_position).norm());
}

/// Of a lost target at a place, as a logarithm: it most likely continued as it did, or nearly; it may have turned round or stopped;
/// and nothing is impossible.
template <int D>
double RosterAdoption<D>::log_density(const Target& target, const Vector<D>& location) const {
  const double speed = target.filter.velocity().norm();
  const auto density = [](double distance, double scale) {
    const double r = distance / scale;
    return std::pow(scale, -D) * std::pow(1 + r * r, -0.5 * (D + 1)) / (2 * std::numbers::pi);
  };
  const double on = density((location - target.filter.position()).norm(), target.width + kEnRoute * speed * target.unobserved);
  const double back = density((location - target.last_position).norm(), target.width + speed * target.unobserved);
  return std::log((1 - kRotated) * on + kRotated * back);
}

/// What it costs to trust that a target that was lost is at a place, or is a newcomer that has stayed there; nothing if it
/// cannot be. Where enough of its rigid neighbours are seen, their misfit decides; else the path.
template <int D>
std::optional<double> RosterAdoption<D>::cost(const Target& target, const Vector<D>& location, const Neighbours& neighbours,
                                              const Target* newcomer) const {
  if (!options_.rigid_neighbours) {
    if (!target.within_reach(location, target.width)) return std::nullopt;
    return std::max(0.0, kMinImprobable - log_density(target, location));
  }
  const bool rotated = rotated_to(target, location);
  if (!rotated && !target.near(location)) return std::nullopt;
  if (const auto misfit = neighbours.misfit(target, location)) return *misfit < kMaxMisfit ? misfit : std::nullopt;
  // Where the body has gone in the meantime is unknown: the distances of a newcomer will prove who it is.
  if (newcomer != nullptr || target.unobserved > kOwnMotion) return std::nullopt;
  const double path = rotated ? path_to(target, location) : (location - target.filter.position()).norm();
  if (!rotated && path > kShortPath * target.width) return std::nullopt;
  return kUnknown + path / target.width;
}

/// Shares `columns` out among `rows` by the pairs' costs.
template <int D>
void RosterAdoption<D>::assign(int rows, int columns) {
  const auto found = assigner_.assign(rows, columns, pairs_);
  columns_.assign(found.begin(), found.end());
  if (!options_.rigid_neighbours) return;
  std::vector<int> ambiguous;
  for (int row = 0; row < rows; ++row) {
    if (columns_[row] != assign::kNoIndex && leaves_ambiguity(row)) ambiguous.push_back(row);
  }
  for (const int row : ambiguous) columns_[row] = assign::kNoIndex;
}

/// Whether another target may as well have the point that the row is given, or the row another point.
template <int D>
bool RosterAdoption<D>::leaves_ambiguity(int row) const {
  const auto price = [&](int r, int c) {
    for (const assign::GatedPair& pair : pairs_) {
      if (pair.row == r && pair.column == c) return 2 * kFar - pair.gain;
    }
    return kNotPriced;
  };
  const int column = columns_[row];
  const double own = price(row, column);
  for (const assign::GatedPair& pair : pairs_) {
    const double other = 2 * kFar - pair.gain;
    if (pair.column == column && pair.row != row) {
      const int theirs = columns_[pair.row];
      const double interchange =
          theirs == assign::kNoIndex ? 0 : std::min(price(row, theirs), own + kClear) - price(pair.row, theirs);
      if (other + interchange - own < kClear) return true;
    }
    if (pair.row == row && pair.column != column) {
      const bool free = std::find(columns_.begin(), columns_.end(), pair.column) == columns_.end();
      if (free && other - own < kClear) return true;
    }
  }
  return false;
}

template <int D>
void RosterAdoption<D>::adopt_points(std::span<Target> targets, std::span<const Observation<D>> detected, std::vector<char>& taken,
                                     const RosterLikelihood<D>& likelihood, const Neighbours& neighbours) {
  if (free_.empty() || std::ssize(lost_) * std::ssize(free_) > kMaxLostPairs) return;
  pairs_.clear();
  for (int row = 0; row < std::ssize(lost_); ++row) {
    const Target& target = targets[lost_[row]];
    for (int column = 0; column < std::ssize(free_); ++column) {
      const Vector<D>& location = detected[free_[column]].value;
      const auto price = cost(target, location, neighbours, nullptr);
      if (!price || !likelihood.alike(target, detected[free_[column]])) continue;
      if (!likelihood.trusts_jump(path_to(target, location) + target.width)) continue;
      if (likelihood.cluttered() && likelihood.log_return(log_density(target, location)) < kReturns) continue;
      pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
    }
  }
  assign(static_cast<int>(lost_.size()), static_cast<int>(free_.size()));
  for (int row = 0; row < std::ssize(lost_); ++row) {
    if (columns_[row] == assign::kNoIndex) continue;
    const int index = free_[columns_[row]];
    restart(targets[lost_[row]], detected[index].value, likelihood.noise_of(detected[index]));
    targets[lost_[row]].observation = index;
    taken[index] = 1;
  }
}

/// The motion before the jump says little of the motion after it; half of the velocity seen since is kept for the start.
template <int D>
void RosterAdoption<D>::restart(Target& target, const Vector<D>& location, const Matrix<D>& R) const {
  const double jump = (location - target.filter.position()).norm();
  const double shortest = (D == 3 ? kSteps : 1) * target.width;
  if (target.filter.gate_distance(location, R) <= kGentleJump || jump < shortest) return;
  filter::AnyFilter<D> fresh(options_.filter, target.last_position, R);
  fresh.predict(target.unobserved);
  if (fresh.gate_distance(location, R) > 1) fresh = filter::AnyFilter<D>(options_.filter, location, R);
  target.filter = std::move(fresh);
}

/// A newcomer that has stayed is one of the targets that are missed.
template <int D>
void RosterAdoption<D>::adopt_newcomers(std::span<Target> targets, const RosterLikelihood<D>& likelihood, Neighbours& neighbours) {
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
        const double there = likelihood.log_return(log_density(target, newcomer.last_position));
        if (newcomer.score + there < kTogether) continue;
      }
      if (options_.rigid_neighbours && newcomer.detected < kStayed) continue;
      const auto price = cost(target, newcomer.last_position, neighbours, &newcomer);
      if (price) pairs_.push_back({row, column, 2 * kFar - std::min(*price, kFar)});
    }
  }
  if (pairs_.empty()) return;
  assign(static_cast<int>(lost_.size()), static_cast<int>(targets.size()));
  for (int row = 0; row < std::ssize(lost_); ++row) {
    if (columns_[row] == assign::kNoIndex) continue;
    Target& target = targets[lost_[row]];
    Target& newcomer = targets[columns_[row]];
    neighbours.adopt(target, newcomer);
    target.filter = newcomer.filter;
    target.observation = newcomer.observation;
    newcomer.observation.reset();
  }
}

template class RosterAdoption<2>;
template class RosterAdoption<3>;

}  // namespace marey::track::roster
