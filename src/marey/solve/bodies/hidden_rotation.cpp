#include "marey/solve/bodies/hidden_rotation.h"

#include <algorithm>
#include <cmath>

#include "marey/geometry/rigid.h"

namespace marey::solve::bodies {
namespace {

constexpr double kStep_s = 0.02;       // numerical: more instants a second say no more of an error over a tenth of one
constexpr double kMaxErrors = 200;     // of errors; older ones are forgotten
constexpr double kOwnPrior = 4;        // errors that the stated acceleration counts for
constexpr double kCarriedCount = 40;   // errors before a body is held for one that carries
constexpr double kMinVariance = 2e-4;  // rad², numerical: 0.8°, what poses themselves are off by

double squared_angle(const Matrix<3>& a, const Matrix<3>& b) {
  return geometry::angle_axis_of(a * b.transpose()).squaredNorm();
}

/// Turned by the mean of both rates.
Matrix<3> by_own_rate(const ObservedRotation& before, const ObservedRotation& after) {
  const double time = seconds(after.time - before.time);
  return geometry::rotation_from(time * (before.rate + after.rate) / 2) * before.rotation;
}

/// Turned as that other body was; nothing if it was not seen at both instants.
std::optional<Matrix<3>> carried_by(std::size_t other, const ObservedRotation& before, const ObservedRotation& after) {
  if (!before.others[other] || !after.others[other]) return std::nullopt;
  return *after.others[other] * before.others[other]->transpose() * before.rotation;
}

}  // namespace

HiddenRotation::HiddenRotation(std::size_t bodies, double angular_acceleration)
    : rate_noise_(angular_acceleration * angular_acceleration * 0.01), carried_(bodies) {}

void HiddenRotation::add(ObservedRotation seen) {
  if (!observed_.empty() && seconds(seen.time - observed_.back().time) < kStep_s) return;
  const auto learn = [](Errors& errors, std::size_t interval, double square) {
    if (errors.count[interval] > kMaxErrors) errors.count[interval] /= 2, errors.squares[interval] /= 2;
    errors.squares[interval] += square;
    ++errors.count[interval];
  };
  for (std::size_t i = 0; i < kIntervals_s.size(); ++i) {
    const Timestamp then = seen.time - duration_from_seconds(kIntervals_s[i]);
    const auto after = std::upper_bound(observed_.begin(), observed_.end(), then,
                                        [](Timestamp t, const ObservedRotation& s) { return t < s.time; });
    if (after == observed_.begin()) continue;  // it was seen for less
    const ObservedRotation& before = *std::prev(after);
    learn(own_, i, squared_angle(by_own_rate(before, seen), seen.rotation));
    for (std::size_t other = 0; other < carried_.size(); ++other) {
      if (const auto due = carried_by(other, before, seen)) learn(carried_[other], i, squared_angle(*due, seen.rotation));
    }
  }
  observed_.push_back(std::move(seen));
  while (seconds(observed_.back().time - observed_.front().time) > kIntervals_s.back() + kStep_s) observed_.pop_front();
}

/// A rate that wanders, bridged by its values at both ends, leaves an angle of variance q T³ / 12 (the integral of a Brownian
/// bridge); errors that were measured over an interval next to it correct that.
double HiddenRotation::own_variance(double hidden_s) const {
  const auto wandering = [&](double time) { return rate_noise_ * time * time * time / 12; };
  double squares = kOwnPrior, count = kOwnPrior;  // in units of that variance
  for (std::size_t i = 0; i < kIntervals_s.size(); ++i) {
    // What is as long as the gap says most; the longest interval stands for all gaps beyond it.
    const bool next = hidden_s > kIntervals_s[i] / 1.5 && (hidden_s < kIntervals_s[i] * 1.5 || i + 1 == kIntervals_s.size());
    if (!next && !(i == 0 && hidden_s < kIntervals_s[0])) continue;
    squares += own_.squares[i] / (3 * wandering(kIntervals_s[i]));
    count += own_.count[i];
  }
  return wandering(hidden_s) * squares / count;
}

/// Nothing if it was not seen beside it long enough.
std::optional<double> HiddenRotation::carried_variance(const Errors& errors, double hidden_s) const {
  std::optional<double> variance;
  for (std::size_t i = 0; i < kIntervals_s.size(); ++i) {
    if (errors.count[i] < kCarriedCount) continue;
    const double longer = std::max(1.0, hidden_s / kIntervals_s[i]);
    variance = errors.squares[i] / errors.count[i] / 3 * longer * longer;
    if (kIntervals_s[i] >= hidden_s) break;
  }
  return variance;
}

DueRotation HiddenRotation::due(const ObservedRotation& before, const ObservedRotation& after) const {
  const double hidden = seconds(after.time - before.time);
  DueRotation best{.rotation = by_own_rate(before, after), .variance = own_variance(hidden)};
  for (std::size_t other = 0; other < carried_.size(); ++other) {
    const auto due = carried_by(other, before, after);
    const auto variance = due ? carried_variance(carried_[other], hidden) : std::nullopt;
    if (variance && *variance < best.variance) best = {.rotation = *due, .variance = *variance};
  }
  best.variance = std::max(best.variance, kMinVariance);
  return best;
}

}  // namespace marey::solve::bodies
