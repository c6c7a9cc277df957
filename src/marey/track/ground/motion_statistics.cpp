#include "marey/track/ground/motion_statistics.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "marey/filter/kalman.h"

namespace marey::track::ground {
namespace {

constexpr double kSpacing = 0.2;  // s: nearer samples err alike, and show little of the motion
constexpr std::size_t kMaxSamples = 20'000, kMinSamples = 200;
constexpr std::size_t kMinLength = 5;  // samples of a path
constexpr double kTails = 4;           // degrees of freedom of Student's distribution
constexpr std::array<double, 11> kAccelerations{0.2, 0.3, 0.4, 0.55, 0.75, 1.0, 1.4, 1.9, 2.6, 3.5, 4.8};
constexpr std::array<double, 6> kNoises{0.5, 0.7, 1, 1.4, 2, 2.8};

struct PathStep {
  double dt = 0;  // s since the one before; 0 begins a path
  Vector<2> location = Vector<2>::Zero();
  Matrix<2> covariance = Matrix<2>::Identity();
};

std::vector<PathStep> path_steps(std::span<const offline::GroundTracklet> tracklets, std::span<const Timestamp> times) {
  std::vector<PathStep> steps;
  for (const offline::GroundTracklet& tracklet : tracklets) {
    const std::size_t begin = steps.size();
    std::optional<Timestamp> last;
    for (const offline::GroundSample& sample : tracklet.samples) {
      const Timestamp now = times[static_cast<std::size_t>(sample.instant)];
      if (last && seconds(now - *last) < kSpacing) continue;
      steps.push_back({last ? seconds(now - *last) : 0, sample.at(), sample.spread()});
      last = now;
    }
    if (steps.size() - begin < kMinLength) steps.resize(begin);
    if (steps.size() > kMaxSamples) break;
  }
  return steps;
}

double speed_of(std::span<const PathStep> steps) {
  double sum = 0, weight = 0;
  for (std::size_t i = 2; i < steps.size(); ++i) {
    // Over three samples, so that errors of places count for less.
    if (steps[i].dt == 0 || steps[i - 1].dt == 0) continue;
    const double dt = steps[i].dt + steps[i - 1].dt;
    const double errors = (steps[i].covariance + steps[i - 2].covariance).trace();
    sum += (steps[i].location - steps[i - 2].location).squaredNorm() - errors;
    weight += 2 * dt * dt;
  }
  return weight > 0 ? std::sqrt(std::max(0.0, sum / weight)) : 0;
}

double log_likelihood(std::span<const PathStep> steps, const filter::KalmanOptions& motion, double noise) {
  double sum = 0;
  std::optional<filter::Kalman<2>> filter;
  int known = 0;
  for (const PathStep& step : steps) {
    const Matrix<2> R = noise * noise * step.covariance;
    if (step.dt == 0) {
      filter.emplace(motion, step.location, R);
      known = 0;
      continue;
    }
    filter->predict(step.dt);
    const Matrix<2> S = filter->innovation_covariance(R);
    const Vector<2> residual = step.location - filter->position();
    if (++known > 1)
      sum -= 0.5 * std::log(S.determinant()) + (kTails + 2) / 2 * std::log1p(residual.dot(S.inverse() * residual) / kTails);
    filter->correct(step.location, R);
  }
  return sum;
}

}  // namespace

std::optional<MotionStatistics> learn_walk(std::span<const offline::GroundTracklet> tracklets, std::span<const Timestamp> times) {
  const std::vector<PathStep> steps = path_steps(tracklets, times);
  if (steps.size() < kMinSamples) return std::nullopt;
  MotionStatistics walk;
  walk.speed = std::max(0.3, speed_of(steps));
  double best = -std::numeric_limits<double>::infinity();
  for (const double acceleration : kAccelerations) {
    for (const double noise : kNoises) {
      const double here =
          log_likelihood(steps, {.acceleration_noise = acceleration, .initial_speed = 2 * walk.speed, .gate_sigmas = 3.5}, noise);
      if (here <= best) continue;
      best = here;
      walk.acceleration = acceleration;
    }
  }
  return walk;
}

}  // namespace marey::track::ground
