#include "marey/filter/fit_noise.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::filter {
namespace {

/// Paths of the model itself: white acceleration of density q², measured with noise of sigma r.
template <int D>
std::vector<MeasuredPath<D>> walks(double q, double r, double dt, int paths, int steps, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Vector<D>::NullaryExpr([&] { return normal(random); }).eval(); };
  std::vector<MeasuredPath<D>> all;
  for (int p = 0; p < paths; ++p) {
    MeasuredPath<D> path;
    Vector<D> x = 100 * draw();
    Vector<D> v = 50 * draw();
    double t = 0;
    for (int k = 0; k < steps; ++k) {
      const double step = k % 10 == 9 ? 3 * dt : dt;  // a gap now and then
      const Vector<D> kick = draw();
      const Vector<D> slip = draw();
      x += step * v + q * std::sqrt(step) * step * (kick / 2 + slip / std::sqrt(12.0));
      v += q * std::sqrt(step) * kick;
      t += step;
      path.times.push_back(t);
      path.positions.push_back(x + r * draw());
    }
    all.push_back(std::move(path));
  }
  return all;
}

TEST(FitNoise, FindsTheNoiseThatWasPutIn) {
  struct Case {
    double q, r, dt;
  };
  for (const Case& c : {Case{200, 0.05, 1.0 / 30}, Case{30, 0.5, 1.0 / 120}, Case{5, 3, 0.04}, Case{2, 0.01, 0.02}}) {
    const auto flat = walks<2>(c.q, c.r, c.dt, 5, 400, 1);
    const auto fit = fit_noise<2>(flat);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->measurement_sigma / c.r, 1, c.q * std::pow(c.dt, 1.5) > 10 * c.r ? 0.5 : 0.1) << c.q << " " << c.r;
    EXPECT_NEAR(fit->acceleration_noise / c.q, 1, 0.15) << c.q << " " << c.r;
    EXPECT_EQ(fit->innovations, 5U * 398U);
    const auto tall = walks<3>(c.q, c.r, c.dt, 5, 400, 2);
    EXPECT_NEAR(fit_noise<3>(tall)->acceleration_noise / c.q, 1, 0.15);
  }
}

TEST(FitNoise, DoesNotKnowTheUnitOfLength) {
  auto paths = walks<2>(50, 0.3, 0.03, 3, 200, 3);
  const auto px = fit_noise<2>(paths);
  for (auto& path : paths) {
    for (auto& position : path.positions) position *= 0.001;
  }
  const auto m = fit_noise<2>(paths);
  EXPECT_NEAR(m->measurement_sigma, 0.001 * px->measurement_sigma, 1e-6 * px->measurement_sigma);
  EXPECT_NEAR(m->acceleration_noise, 0.001 * px->acceleration_noise, 1e-6 * px->acceleration_noise);
}

TEST(FitNoise, SaysNothingWhereThereIsNothing) {
  EXPECT_FALSE(fit_noise<2>({}));
  EXPECT_FALSE(fit_noise<2>(walks<2>(1, 1, 0.1, 3, 2, 4)));  // two positions each
  EXPECT_FALSE(fit_noise<2>(walks<2>(1, 1, 0.1, 1, 5, 4)));
  MeasuredPath<2> still;
  for (int k = 0; k < 100; ++k) {
    still.times.push_back(0.1 * k);
    still.positions.push_back({5, 5});
  }
  const std::vector<MeasuredPath<2>> paths = {still};
  EXPECT_FALSE(fit_noise<2>(paths));
}

TEST(FitNoise, AFittedKalmanPredictsBestWithItsOwnNoise) {
  const auto paths = walks<2>(20, 0.5, 0.04, 4, 300, 5);
  const auto fit = fit_noise<2>(paths);
  ASSERT_TRUE(fit);
  const auto error = [&](double acceleration_noise) {
    double sum = 0;
    const Matrix<2> R = fit->measurement_sigma * fit->measurement_sigma * Matrix<2>::Identity();
    for (const auto& path : paths) {
      Kalman<2> filter({.acceleration_noise = acceleration_noise}, path.positions[0], R);
      for (std::size_t k = 1; k < path.times.size(); ++k) {
        filter.predict(path.times[k] - path.times[k - 1]);
        if (k > 20) sum += (filter.position() - path.positions[k]).squaredNorm();
        filter.correct(path.positions[k], R);
      }
    }
    return sum;
  };
  const auto fitted = std::get<KalmanOptions>(with_noise(KalmanOptions{}, *fit));
  EXPECT_EQ(fitted.acceleration_noise, fit->acceleration_noise);
  EXPECT_LT(error(fitted.acceleration_noise), error(4 * fitted.acceleration_noise));
  EXPECT_LT(error(fitted.acceleration_noise), error(fitted.acceleration_noise / 4));
}

TEST(FitNoise, EveryFilterTakesItOrStaysAsItIs) {
  const NoiseFit fit{.measurement_sigma = 0.2, .acceleration_noise = 30, .acceleration = 160, .speed = 10};
  for (const NamedFilter& filter : named_filters()) EXPECT_EQ(name_of(with_noise(filter.options, fit)), filter.name);
  EXPECT_EQ(std::get<ExtendedKalmanOptions>(with_noise(ExtendedKalmanOptions{}, fit)).noise.acceleration_noise, 30);
  const auto imm = std::get<InteractingModelsOptions>(with_noise(InteractingModelsOptions{}, fit));
  EXPECT_NEAR(imm.acceleration, std::sqrt(160 * 160 - std::pow(imm.agility * 10, 2)), 1e-9);
}

}  // namespace
}  // namespace marey::filter
