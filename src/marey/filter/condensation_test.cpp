#include "marey/filter/condensation.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/filter/filter.h"

namespace marey::filter {
namespace {

static_assert(Filter<Condensation<2>> && Filter<Condensation<3>>);

/// The exact state of a linear, normal target: Kalman's posterior for one axis, (p) or (p, v).
struct Exact {
  Matrix<2> P = Matrix<2>::Zero();
  Vector<2> x = Vector<2>::Zero();

  void predict(double dt, const CondensationOptions& options) {
    // The particles' own step: half a drift, the velocity's kick, half a drift, the position's diffusion.
    Matrix<2> half = Matrix<2>::Identity();
    half(0, 1) = options.with_velocity ? 0.5 * dt : 0;
    P = half * P * half.transpose();
    if (options.with_velocity) P(1, 1) += options.velocity_diffusion * options.velocity_diffusion * dt;
    P = (half * P * half.transpose()).eval();
    P(0, 0) += options.diffusion * options.diffusion * dt;
    x = half * half * x;
  }
  void correct(double z, double variance) {
    const Vector<2> K = P.col(0) / (P(0, 0) + variance);
    x += K * (z - x[0]);
    P = (P - K * P.row(0)).eval();
  }
};

/// Largest distance from the exact mean over a run, in exact standard deviations, and the worst ratio of variances.
std::pair<double, double> errors(CondensationOptions options, int particles) {
  options.particles = particles;
  options.likelihood_sigma = 1;
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  const double variance = 0.5 + 1;  // R and likelihood_sigma²
  Exact exact;
  exact.P(0, 0) = options.initial_spread * options.initial_spread;
  exact.P(1, 1) = options.initial_speed * options.initial_speed;
  Condensation<2> filter(options, {0, 0}, Matrix<2>::Identity());
  double distance = 0;
  double ratio = 1;
  for (int step = 1; step <= 30; ++step) {
    const double z = 2 * step + normal(random);
    filter.predict(0.04);
    exact.predict(0.04, options);
    if (step % 5 != 0) {
      filter.correct({z, -z}, 0.5 * Matrix<2>::Identity());
      exact.correct(z, variance);
    }
    const double sigma = std::sqrt(exact.P(0, 0));
    distance = std::max(
        {distance, std::abs(filter.position()[0] - exact.x[0]) / sigma, std::abs(filter.position()[1] + exact.x[0]) / sigma});
    const double r = filter.covariance()(0, 0) / exact.P(0, 0);
    ratio = std::max({ratio, r, 1 / r});
  }
  return {distance, ratio};
}

TEST(Condensation, ManyParticlesAreTheExactPosterior) {
  CondensationOptions resting;
  resting.diffusion = 20;
  CondensationOptions moving = CondensationOptions::velocity();
  moving.initial_speed = 60;
  moving.velocity_diffusion = 100;
  for (const CondensationOptions& options : {resting, moving}) {
    const auto [distance, ratio] = errors(options, 200'000);
    EXPECT_LE(distance, 0.05);
    EXPECT_LE(ratio, 1.05);
  }
}

TEST(Condensation, TheErrorFallsAsTheRootOfTheNumber) {
  CondensationOptions options;
  options.diffusion = 20;
  EXPECT_LT(errors(options, 20'000).first, errors(options, 200).first / 3);
}

TEST(Condensation, TheSameSeedIsTheSameBitForBit) {
  const auto run = [](std::uint64_t seed) {
    CondensationOptions options = CondensationOptions::velocity();
    options.seed = seed;
    Condensation<3> filter(options, {1, 2, 3}, Matrix<3>::Identity());
    for (int i = 0; i < 20; ++i) {
      filter.predict(0.03);
      filter.correct(Vector<3>::Constant(i), Matrix<3>::Identity());
    }
    return filter.position();
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

TEST(Condensation, AMeasurementFarFromEveryParticleSelectsTheNearest) {
  CondensationOptions options;
  Condensation<2> filter(options, {0, 0}, Matrix<2>::Identity());
  filter.predict(0.03);
  filter.correct({1e9, 0}, Matrix<2>::Identity());
  EXPECT_TRUE(filter.position().allFinite());
  EXPECT_GT(filter.position()[0], 10);
}

TEST(RandomStream, IsUniformAndNormal) {
  RandomStream random(1);
  double mean = 0;
  double square = 0;
  double fourth = 0;
  double product = 0;
  constexpr int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const auto [a, b] = random.normal_pair();
    mean += a / n;
    square += a * a / n;
    fourth += b * b * b * b / n;
    product += a * b / n;
  }
  EXPECT_NEAR(mean, 0, 0.01);
  EXPECT_NEAR(square, 1, 0.02);
  EXPECT_NEAR(fourth, 3, 0.15);
  EXPECT_NEAR(product, 0, 0.01);
}

}  // namespace
}  // namespace marey::filter
