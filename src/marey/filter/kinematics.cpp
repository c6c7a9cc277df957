#include "marey/filter/kinematics.h"

namespace marey::filter::kinematics {
namespace {

// Below this product of rate and time, closed forms lose digits by cancellation and Taylor series are used instead.
constexpr double kSmall = 0.25;

/// Σ coefficients[n] xⁿ.
template <std::size_t N>
double polynomial(const std::array<double, N>& coefficients, double x) {
  double sum = coefficients[N - 1];
  for (std::size_t n = N - 1; n-- > 0;) sum = sum * x + coefficients[n];
  return sum;
}

/// (x − 1 + e⁻ˣ) / x².
double second_integral_of_decay(double x) {
  if (x > kSmall) return (x - 1 + std::exp(-x)) / (x * x);
  // Σ (−x)ⁿ / (n + 2)!
  return polynomial<9>({1. / 2, -1. / 6, 1. / 24, -1. / 120, 1. / 720, -1. / 5040, 1. / 40320, -1. / 362880, 1. / 3628800}, x);
}

/// The jerk's white noise integrated over dt: Q of constant acceleration for a density of 1.
Matrix<3> white_jerk(double dt) {
  const double t2 = dt * dt;
  const double t3 = t2 * dt;
  Matrix<3> Q;
  Q << t3 * t2 / 20, t2 * t2 / 8, t3 / 6,  //
      t2 * t2 / 8, t3 / 3, t2 / 2,         //
      t3 / 6, t2 / 2, dt;
  return Q;
}

/// Singer's Q over sigma² from its six brackets, pp, pv, pa, vv, va, aa.
Matrix<3> singer_noise(const std::array<double, 6>& bracket, double time) {
  const double t2 = time * time;
  const double pv = t2 * time * bracket[1];
  const double pa = t2 * bracket[2];
  const double va = time * bracket[4];
  Matrix<3> Q;
  Q << t2 * t2 * bracket[0], pv, pa, pv, t2 * bracket[3], va, pa, va, bracket[5];
  return Q;
}

/// By his closed form; x = dt/time is not small.
Matrix<3> singer_noise_closed(double x, double time) {
  const double e = std::exp(-x);
  const double e2 = e * e;
  return singer_noise({1 - e2 + 2 * x + 2 * x * x * x / 3 - 2 * x * x - 4 * x * e, e2 + 1 - 2 * e + 2 * x * e - 2 * x + x * x,
                       1 - e2 - 2 * x * e, 4 * e - 3 - e2 + 2 * x, e2 + 1 - 2 * e, 1 - e2},
                      time);
}

constexpr int kTerms = 16;

/// Taylor coefficients of x to x¹⁵ of the six brackets above, pp, pv, pa, vv, va, aa; all lower powers cancel.
constexpr std::array<std::array<double, 6>, kTerms> singer_series() {
  std::array<std::array<double, 6>, kTerms> series = {};
  double sign = 1;     // (−1)ⁿ / n!
  double doubled = 1;  // 2ⁿ
  for (int n = 1; n < kTerms; ++n) {
    sign /= -n;
    doubled *= 2;
    const std::array<double, 6> bracket = {4.0 * n - doubled, doubled - 2 - 2.0 * n, 2.0 * n - doubled,
                                           4 - doubled,       doubled - 2,           -doubled};
    constexpr std::array<int, 6> kMinLevel = {5, 4, 3, 3, 2, 1};
    for (std::size_t k = 0; k < 6; ++k) series[static_cast<std::size_t>(n)][k] = n < kMinLevel[k] ? 0 : sign * bracket[k];
  }
  return series;
}

/// The same for small x.
Matrix<3> singer_noise_small(double x, double time) {
  static constexpr auto kSeries = singer_series();
  std::array<double, 6> sum = kSeries.back();
  for (std::size_t n = kTerms - 1; n-- > 0;) {
    for (std::size_t k = 0; k < 6; ++k) sum[k] = sum[k] * x + kSeries[n][k];
  }
  return singer_noise(sum, time);
}

}  // namespace

Model<2> constant_velocity(double dt, double density) {
  Model<2> model;
  model.F << 1, dt, 0, 1;
  model.Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  model.Q *= density;
  return model;
}

Model<3> constant_acceleration(double dt, double density) {
  Model<3> model;
  model.F << 1, dt, dt * dt / 2, 0, 1, dt, 0, 0, 1;
  model.Q = density * white_jerk(dt);
  return model;
}

Model<3> singer(double dt, double sigma, double time) {
  const double x = dt / time;
  const double second = second_integral_of_decay(x);
  const double first = 1 - x * second;  // (1 − e⁻ˣ) / x
  Model<3> model;
  model.F << 1, dt, dt * dt * second, 0, 1, dt * first, 0, 0, 1 - x * first;
  model.Q = (sigma * sigma) * (x > kSmall ? singer_noise_closed(x, time) : singer_noise_small(x, time));
  return model;
}

Model<3> turn(double dt, double rate, double density) {
  const double angle = rate * dt;
  const double c = std::cos(angle);
  double sine = dt - angle * angle * dt / 6;             // sin(angle)/rate
  double cosine = dt * dt * (0.5 - angle * angle / 24);  // (1 − cos(angle))/rate²
  if (std::abs(angle) > 1e-3) {
    sine = std::sin(angle) / rate;
    const double half = std::sin(0.5 * angle) / rate;
    cosine = 2 * half * half;
  }
  Model<3> model;
  model.F << 1, sine, cosine, 0, c, sine, 0, -rate * rate * sine, c;
  model.Q = density * white_jerk(dt);
  return model;
}

}  // namespace marey::filter::kinematics
