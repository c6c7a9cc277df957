#include "marey/filter/kinematics.h"

namespace marey::kinematics {
namespace {

// Below this product of rate and time, closed forms lose digits by cancellation and Taylor series are used instead.
constexpr double kSmall = 0.5;

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
  return polynomial<11>({1. / 2, -1. / 6, 1. / 24, -1. / 120, 1. / 720, -1. / 5040, 1. / 40320, -1. / 362880, 1. / 3628800,
                         -1. / 39916800, 1. / 479001600},
                        x);
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

/// Singer's Q over sigma², by his closed form; x = dt/time is not small.
Matrix<3> singer_noise_closed(double x, double time) {
  const double e = std::exp(-x);
  const double e2 = e * e;
  const double pp = 1 - e2 + 2 * x + 2 * x * x * x / 3 - 2 * x * x - 4 * x * e;
  const double pv = e2 + 1 - 2 * e + 2 * x * e - 2 * x + x * x;
  const double pa = 1 - e2 - 2 * x * e;
  const double vv = 4 * e - 3 - e2 + 2 * x;
  const double va = e2 + 1 - 2 * e;
  const double t2 = time * time;
  Matrix<3> Q;
  Q << t2 * t2 * pp, t2 * time * pv, t2 * pa,  //
      t2 * time * pv, t2 * vv, time * va,      //
      t2 * pa, time * va, 1 - e2;
  return Q;
}

/// The same for small x: by Gauss–Legendre's rule with five points on ∫ g gᵀ, g the response to a kick of the acceleration.
Matrix<3> singer_noise_small(double x, double dt, double time) {
  constexpr std::array<double, 5> kPoint = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 5> kWeight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                             0.2369268850561891};
  Matrix<3> Q = Matrix<3>::Zero();
  for (std::size_t k = 0; k < kPoint.size(); ++k) {
    const double u = 0.5 * (1 + kPoint[k]);
    const double s = u * dt;
    const double second = second_integral_of_decay(u * x);
    const double first = 1 - u * x * second;
    const Vector<3> g(s * s * second, s * first, 1 - u * x * first);
    Q += (0.5 * dt * kWeight[k]) * g * g.transpose();
  }
  return Q * (2 / time);
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
  model.Q = (sigma * sigma) * (x > kSmall ? singer_noise_closed(x, time) : singer_noise_small(x, dt, time));
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

}  // namespace marey::kinematics
