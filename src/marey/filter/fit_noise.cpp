#include "marey/filter/fit_noise.h"

#include <algorithm>
#include <cmath>

#include "marey/geometry/median.h"

namespace marey::filter {
namespace {

constexpr std::size_t kMinInnovations = 10;

struct Scored {
  double log_likelihood = 0;
  double measurement_variance = 0;
  std::size_t innovations = 0;
};

/// The likelihood of all paths for q = ratio · r, with the best r. One axis's covariance serves all: (pp, pv, vv) in units of r.
/// The first two positions of a path set its state: velocity is not known before.
template <int D>
Scored score(std::span<const MeasuredPath<D>> paths, double ratio) {
  double squares = 0;
  double log_sizes = 0;
  Scored scored;
  for (const MeasuredPath<D>& path : paths) {
    if (path.positions.size() < 3) continue;
    const double first = path.times[1] - path.times[0];
    Vector<D> x = path.positions[1];
    Vector<D> v = (path.positions[1] - path.positions[0]) / first;
    double pp = 1;
    double pv = 1 / first;
    double vv = 2 / (first * first) + ratio * first / 3;
    for (std::size_t k = 2; k < path.positions.size(); ++k) {
      const double dt = path.times[k] - path.times[k - 1];
      x += dt * v;
      pp += 2 * dt * pv + dt * dt * vv + ratio * dt * dt * dt / 3;
      pv += dt * vv + ratio * dt * dt / 2;
      vv += ratio * dt;
      const double s = pp + 1;
      const Vector<D> innovation = path.positions[k] - x;
      squares += innovation.squaredNorm() / s;
      log_sizes += std::log(s);
      ++scored.innovations;
      x += (pp / s) * innovation;
      v += (pv / s) * innovation;
      vv -= pv * pv / s;
      pv /= s;
      pp /= s;
    }
  }
  const double n = static_cast<double>(scored.innovations) * D;
  scored.measurement_variance = n > 0 ? squares / n : 0;
  constexpr double kLogTwoPi = 1.8378770664093453;
  scored.log_likelihood = -0.5 * (n * (kLogTwoPi + 1 + std::log(scored.measurement_variance)) + D * log_sizes);
  return scored;
}

/// The place of the largest value of `f` over [low, high]: a grid, then the golden section round its best point.
template <typename F>
double maximise(F&& f, double low, double high, int grid) {
  const double width = (high - low) / grid;
  double best = low;
  double maximum = f(low);
  for (int i = 1; i <= grid; ++i) {
    const double x = low + i * width;
    if (const double value = f(x); value > maximum) {
      maximum = value;
      best = x;
    }
  }
  constexpr double kGolden = 0.6180339887498949;
  double a = best - width;
  double b = best + width;
  double x1 = b - kGolden * (b - a);
  double x2 = a + kGolden * (b - a);
  double f1 = f(x1);
  double f2 = f(x2);
  for (int i = 0; i < 25; ++i) {
    if (f1 > f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      f1 = f(x1 = b - kGolden * (b - a));
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      f2 = f(x2 = a + kGolden * (b - a));
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

template <int D>
std::optional<NoiseFit> fit_noise(std::span<const MeasuredPath<D>> paths) {
  std::vector<double> steps;
  double travelled = 0;
  double elapsed = 0;
  for (const MeasuredPath<D>& path : paths) {
    for (std::size_t k = 1; k < path.positions.size(); ++k) {
      const double dt = path.times[k] - path.times[k - 1];
      steps.push_back(dt);
      travelled += (path.positions[k] - path.positions[k - 1]).squaredNorm() / dt;
      elapsed += dt;
    }
  }
  if (steps.empty()) return std::nullopt;
  const double step = geometry::median(steps);

  // The ratio without a unit: q step³ / r, from all noise in the measurement to all in the motion.
  const double unit = 1 / (step * step * step);
  const auto ratio = [&](double exponent) { return unit * std::exp(exponent); };
  const double exponent = maximise([&](double e) { return score<D>(paths, ratio(e)).log_likelihood; }, -25, 20, 30);
  const Scored best = score<D>(paths, ratio(exponent));
  if (best.innovations < kMinInnovations || !(best.measurement_variance > 0)) return std::nullopt;

  NoiseFit fit;
  fit.measurement_sigma = std::sqrt(best.measurement_variance);
  fit.acceleration_noise = std::sqrt(ratio(exponent) * best.measurement_variance);
  fit.acceleration = fit.acceleration_noise / std::sqrt(step);
  fit.speed = std::sqrt(travelled / (elapsed * D));
  fit.log_likelihood = best.log_likelihood;
  fit.innovations = best.innovations;
  return fit;
}

namespace {

struct Apply {
  const NoiseFit& fit;

  FilterOptions operator()(AlphaBetaOptions options) const { return options; }
  FilterOptions operator()(AlphaBetaVariableOptions options) const { return options; }
  FilterOptions operator()(ExtrapolationOptions options) const { return options; }
  FilterOptions operator()(KalmanPaperOptions options) const { return options; }
  FilterOptions operator()(CustomFilterOptions options) const { return options; }
  FilterOptions operator()(KalmanOptions options) const {
    options.acceleration_noise = fit.acceleration_noise;
    return options;
  }
  FilterOptions operator()(KalmanAccelerationOptions options) const {
    // Jerk under which acceleration strays by its own size over a typical change of it, half a second.
    options.jerk_noise = fit.acceleration * std::sqrt(2.0);
    options.initial_acceleration = fit.acceleration;
    return options;
  }
  FilterOptions operator()(ExtendedKalmanOptions options) const {
    options.noise.acceleration_noise = fit.acceleration_noise;
    return options;
  }
  FilterOptions operator()(UnscentedKalmanOptions options) const {
    options.noise.acceleration_noise = fit.acceleration_noise;
    return options;
  }
  FilterOptions operator()(CondensationOptions options) const {
    options.likelihood_sigma = std::max(options.likelihood_sigma, fit.measurement_sigma);
    if (options.with_velocity) options.velocity_diffusion = fit.acceleration_noise;
    return options;
  }
  FilterOptions operator()(InteractingModelsOptions options) const {
    // The part of the acceleration that speed does not explain.
    const double explained = options.agility * fit.speed;
    options.acceleration = std::sqrt(
        std::max(0.01 * fit.acceleration * fit.acceleration, fit.acceleration * fit.acceleration - explained * explained));
    return options;
  }
};

}  // namespace

FilterOptions with_noise(const FilterOptions& options, const NoiseFit& fit) {
  return std::visit(Apply{fit}, options);
}

template std::optional<NoiseFit> fit_noise<2>(std::span<const MeasuredPath<2>>);
template std::optional<NoiseFit> fit_noise<3>(std::span<const MeasuredPath<3>>);

}  // namespace marey::filter
