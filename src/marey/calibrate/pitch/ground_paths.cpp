#include "marey/calibrate/pitch/ground_paths.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "marey/geometry/local_polynomial.h"

namespace marey::calibrate::pitch {
namespace {

constexpr double kReach_s = 0.5;        // of the parabola, to both sides
constexpr double kNear_s = 0.25;        // something must have been seen so near on both sides
constexpr std::size_t kMinSamples = 4;  // numerical: a parabola has three unknowns
constexpr double kIndependent = 2;      // errors of a second's samples hang together: they are worth this many

/// The parabola through `samples` about `time_s`; nothing if they do not hold it.
std::optional<SmoothPath::State> fit(std::span<const GroundPath::Sample> samples, double time_s) {
  if (samples.size() < kMinSamples || samples.front().time_s > time_s - kNear_s || samples.back().time_s < time_s + kNear_s)
    return std::nullopt;
  geometry::LocalPolynomial<3, 2> parabola;
  Matrix<2> noise = Matrix<2>::Zero();
  double total = 0;
  for (const GroundPath::Sample& sample : samples) {
    const double u = (sample.time_s - time_s) / kReach_s;
    const double bell = 1 - u * u;
    const double weight = bell / std::max(sample.covariance.trace(), 1e-6);
    parabola.add(u, weight, sample.location.transpose());
    noise += bell * sample.covariance;
    total += bell;
  }
  if (!(total > 0)) return std::nullopt;
  const auto found = parabola.well_determined_fit(1e-9);
  if (!found) return std::nullopt;
  return SmoothPath::State{found->row(0), found->row(1) / kReach_s, noise / total / kIndependent};
}

}  // namespace

SmoothPath::SmoothPath(const GroundPath& path) {
  const auto& samples = path.samples;
  if (samples.size() < kMinSamples) return;
  begin_s_ = samples.front().time_s;
  const auto steps = static_cast<std::size_t>((samples.back().time_s - begin_s_) / kStep_s) + 1;
  std::size_t first = 0, end = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double time = begin_s_ + kStep_s * static_cast<double>(i);
    while (first < samples.size() && samples[first].time_s <= time - kReach_s) ++first;
    while (end < samples.size() && samples[end].time_s < time + kReach_s) ++end;
    states_.push_back(fit(std::span(samples).subspan(first, end - first), time));
  }
}

std::optional<SmoothPath::State> SmoothPath::at(double time_s) const {
  const double location = (time_s - begin_s_) / kStep_s;
  if (!(location >= 0) || location >= static_cast<double>(states_.size()) - 1) return std::nullopt;
  const auto i = static_cast<std::size_t>(location);
  const auto &a = states_[i], &b = states_[i + 1];
  if (!a || !b) return std::nullopt;
  // Hermite's cubic: velocities are known too.
  const double u = location - static_cast<double>(i), w = 1 - u;
  State result;
  result.location = w * w * (1 + 2 * u) * a->location + u * u * (1 + 2 * w) * b->location +
                    kStep_s * (u * w * w * a->velocity - u * u * w * b->velocity);
  result.velocity = w * a->velocity + u * b->velocity;
  result.noise = w * a->noise + u * b->noise;
  return result;
}

}  // namespace marey::calibrate::pitch
