#include "marey/track/roster/roster_matching.h"

#include <algorithm>
#include <cmath>

namespace marey::track::roster {
namespace {

constexpr double kRoom = 24;      // twice the log-likelihood that a pair may cost
constexpr double kMaxGate = 5;    // standard deviations
constexpr double kComesBack = 5;  // log-likelihood ratio against clutter from which a point brings a target back
// The same of one that was just seen: a corner is likelier than that it is hidden now.
constexpr double kVisiblePrior = 14;
constexpr std::size_t kFewPairs = 4096;  // below this, every pair is weighed
constexpr double kLogTwoPi = 1.8378770664093453;

double square_of(double value) {
  return value * value;
}

}  // namespace

template <int D>
void RosterMatching<D>::match(std::span<Target> targets, std::span<const char> required, std::span<const Observation<D>> detected,
                              std::vector<char>& taken, double dt, const RosterLikelihood<D>& likelihood,
                              const RosterRigidNeighbours<D>& neighbours) {
  points_.clear();
  for (const Observation<D>& point : detected) points_.push_back(point.value);
  const bool few = targets.size() * detected.size() <= kFewPairs;
  if (!few) grid_.build(points_, 2 * options_.marker_width);
  pairs_.clear();
  const Spread spread = spread_of(detected, likelihood);
  for (int row = 0; row < std::ssize(targets); ++row) {
    if (!required[row]) continue;
    const double reach = reach_of(targets[row], spread);
    const auto consider = [&](int column) {
      if ((points_[column] - targets[row].filter.position()).squaredNorm() > reach * reach) return;
      if (taken[column]) return;
      const double merit = gain(targets[row], detected[column], dt, likelihood);
      if (merit > 0 && neighbours.agree(targets, row, points_[column], dt)) pairs_.push_back({row, column, merit});
    };
    if (few) {
      for (int column = 0; column < std::ssize(detected); ++column) consider(column);
    } else {
      grid_.for_each_near(targets[row].filter.position(), search_radius(targets[row]), consider);
    }
  }
  const auto columns = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(detected.size()), pairs_);
  for (int row = 0; row < std::ssize(targets); ++row) {
    if (columns[row] == assign::kNoIndex) continue;
    targets[row].observation = columns[row];
    taken[columns[row]] = 1;
  }
}

template <int D>
auto RosterMatching<D>::spread_of(std::span<const Observation<D>> detected, const RosterLikelihood<D>& likelihood) const -> Spread {
  Spread spread;
  for (const Observation<D>& point : detected) {
    const double width = likelihood.width_of(point);
    spread.variance = std::max(spread.variance, likelihood.noise_of(point).trace());
    spread.narrowest = &point == detected.data() ? width : std::min(spread.narrowest, width);
    spread.widest = std::max(spread.widest, width);
  }
  return spread;
}

/// No pair farther apart than this can be worth anything: asked first, because it costs least.
template <int D>
double RosterMatching<D>::reach_of(const Target& target, const Spread& spread) const {
  const double fastest = options_.max_speed * target.unobserved + target.width;
  const double change =
      std::max(spread.widest - target.width, target.width - spread.narrowest) - RosterLikelihood<D>::kWidthNoise * target.width;
  return std::min(fastest, target.filter.search_reach(spread.variance + square_of(std::max(0.0, change))));
}

/// The farthest that a point in the search area can be: the gate's own radius along its longest axis.
template <int D>
double RosterMatching<D>::search_radius(const Target& target) const {
  const Matrix<D> S = target.filter.innovation_covariance(Matrix<D>::Zero());
  return std::min(kMaxGate * std::sqrt(S.trace()) + 2 * target.width, options_.max_speed * target.unobserved + target.width);
}

/// What the pair is worth: the logarithm of its likelihood, above that at the border of the search area.
template <int D>
double RosterMatching<D>::gain(const Target& target, const Observation<D>& point, double dt,
                               const RosterLikelihood<D>& likelihood) const {
  const Vector<D> residual = point.value - target.filter.position();
  if (residual.squaredNorm() > square_of(options_.max_speed * target.unobserved + target.width)) return 0;
  const Matrix<D> R = likelihood.noise_of(point, target);
  if (target.filter.gate_distance(point.value, R) > 1) return 0;
  const double log_likelihood = target.filter.log_likelihood(point.value, R);
  if (target.unobserved > 1.5 * dt) {
    if (D == 2 && !target.within_reach(point.value, target.width)) return 0;
    if (!likelihood.trusts_jump(residual.norm() + target.width)) return 0;
    if (likelihood.cluttered() && likelihood.log_return(log_likelihood) < kComesBack) return 0;
  }
  if (likelihood.cluttered()) {  // against a false point here and, where the target is known to be there, none of its own
    return 2 * (likelihood.log_return(log_likelihood) + (target.standing == Target::Standing::established ? kVisiblePrior : 0));
  }
  const double cost = -2 * log_likelihood - D * kLogTwoPi - 2 * std::log(square_of(options_.marker_width));
  return std::max(1e-3, kRoom - cost) + (target.on_roster() ? kRoom : 0);
}

template class RosterMatching<2>;
template class RosterMatching<3>;

}  // namespace marey::track::roster
