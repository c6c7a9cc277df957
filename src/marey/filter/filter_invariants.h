// The invariants of the Filter concept as a typed test suite. A filter's test instantiates it for both dimensions:
//
//   INSTANTIATE_TYPED_TEST_SUITE_P(Kalman, FilterInvariants, testing::Types<Kalman<2>, Kalman<3>>);
#pragma once

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "marey/filter/filter.h"

namespace marey::filter {

template <typename F>
class FilterInvariants : public testing::Test {
 public:
  static constexpr int size = F::dimension;

  Vector<size> random_vector(double sigma) {
    std::normal_distribution<double> normal(0, sigma);
    Vector<size> v;
    for (int i = 0; i < size; ++i) v[i] = normal(random_);
    return v;
  }

  /// Symmetric and positive, with axes of different length.
  Matrix<size> random_covariance(double sigma) {
    Matrix<size> A;
    for (int i = 0; i < size; ++i) A.col(i) = random_vector(sigma);
    return A * A.transpose() + 0.01 * sigma * sigma * Matrix<size>::Identity();
  }

  /// A filter that has seen a noisy straight walk of 20 uneven steps.
  F experienced() {
    const Vector<size> velocity = random_vector(100);
    Vector<size> x = random_vector(200);
    F filter(typename F::Options{}, x, Matrix<size>::Identity());
    std::uniform_real_distribution<double> step(0.02, 0.1);
    for (int i = 0; i < 20; ++i) {
      const double dt = step(random_);
      x += dt * velocity;
      filter.predict(dt);
      filter.correct(x + random_vector(1), Matrix<size>::Identity());
    }
    return filter;
  }

  static void expect_valid(const Matrix<size>& P) {
    ASSERT_TRUE(P.allFinite());
    EXPECT_LE((P - P.transpose()).cwiseAbs().maxCoeff(), 1e-9 * (1 + P.cwiseAbs().maxCoeff()));
    const Vector<size> values = Eigen::SelfAdjointEigenSolver<Matrix<size>>(P, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GE(values.minCoeff(), -1e-9 * (1 + values.maxCoeff()));
  }

  /// Whether the estimate is the mean of several hypotheses or of particles, which a measurement weighs anew.
  static constexpr bool mixture = requires { requires F::mixture; };
  /// Whether the estimate carries the noise of random particles.
  static constexpr bool sampled = requires { requires F::sampled; };
  /// Whether the velocity is that of the last few measurements as they are, noise and all.
  static constexpr bool unsmoothed = requires { requires F::unsmoothed; };
  /// Whether the model is a target that stands still.
  static constexpr bool at_rest = requires { requires F::at_rest; };

  std::mt19937 random_{20};  // NOLINT: a seed, so that a failure comes back
};

TYPED_TEST_SUITE_P(FilterInvariants);

TYPED_TEST_P(FilterInvariants, BeginsAtItsFirstMeasurementAtRest) {
  constexpr int D = TypeParam::dimension;
  const Vector<D> z = this->random_vector(200);
  const TypeParam filter(typename TypeParam::Options{}, z, this->random_covariance(2));
  EXPECT_LE((filter.position() - z).norm(), 1e-9);
  EXPECT_LE(filter.velocity().norm(), 1e-9);
}

TYPED_TEST_P(FilterInvariants, PredictingNoTimeChangesNothing) {
  TypeParam filter = this->experienced();
  const TypeParam before = filter;
  filter.predict(0);
  EXPECT_LE((filter.position() - before.position()).norm(), 1e-9);
  EXPECT_LE((filter.velocity() - before.velocity()).norm(), 1e-9);
  EXPECT_LE((filter.covariance() - before.covariance()).norm(), 1e-9 * (1 + before.covariance().norm()));
}

TYPED_TEST_P(FilterInvariants, AMeasurementAtThePredictionDoesNotMoveIt) {
  TypeParam filter = this->experienced();
  filter.predict(0.04);
  const auto position = filter.position();
  filter.correct(position, this->random_covariance(1));
  const double allowed = TestFixture::mixture ? 0.5 * std::sqrt(filter.covariance().trace()) : 1e-6 * (1 + position.norm());
  EXPECT_LE((filter.position() - position).norm(), allowed);
}

TYPED_TEST_P(FilterInvariants, CovariancesStaySymmetricAndPositive) {
  constexpr int D = TypeParam::dimension;
  for (int trial = 0; trial < 20; ++trial) {
    TypeParam filter = this->experienced();
    for (int i = 0; i < 50; ++i) {
      filter.predict(0.04 * (i % 3));
      const Matrix<D> R = this->random_covariance(i % 7 == 0 ? 1e-3 : 3);
      this->expect_valid(filter.covariance());
      this->expect_valid(filter.innovation_covariance(R));
      if (i % 4 != 0) filter.correct(filter.position() + this->random_vector(3), R);
    }
    this->expect_valid(filter.covariance());
  }
}

TYPED_TEST_P(FilterInvariants, WaitingDoesNotMakeItSurer) {
  TypeParam filter = this->experienced();
  double before = filter.covariance().trace();
  for (int i = 0; i < 10; ++i) {
    filter.predict(0.04);
    EXPECT_GE(filter.covariance().trace(), before * (1 - (TestFixture::sampled ? 0.1 : 1e-9)));
    before = filter.covariance().trace();
  }
}

TYPED_TEST_P(FilterInvariants, ASteadyWalkIsFollowedWithoutBias) {
  constexpr int D = TypeParam::dimension;
  const Vector<D> velocity = Vector<D>::Constant(TestFixture::at_rest ? 0 : 60);
  Vector<D> x = Vector<D>::Constant(100);
  const Matrix<D> R = 0.25 * Matrix<D>::Identity();
  TypeParam filter(typename TypeParam::Options{}, x, R);
  Vector<D> sum = Vector<D>::Zero();
  constexpr int steps = 400;
  constexpr int settled = 100;
  for (int i = 0; i < steps; ++i) {
    const double dt = i % 2 == 0 ? 0.03 : 0.05;
    x += dt * velocity;
    filter.predict(dt);
    if (i >= settled) sum += filter.position() - x;
    filter.correct(x + this->random_vector(0.5), R);
  }
  EXPECT_LE((sum / (steps - settled)).norm(), 0.3);
  EXPECT_LE((filter.velocity() - velocity).norm(), TestFixture::unsmoothed ? 200 : 40);
}

TYPED_TEST_P(FilterInvariants, TheSearchAreaIsCentredOnThePrediction) {
  constexpr int D = TypeParam::dimension;
  TypeParam filter = this->experienced();
  filter.predict(0.04);
  const Matrix<D> R = Matrix<D>::Identity();
  EXPECT_LE(filter.gate_distance(filter.position(), R), 1e-3);
  const Vector<D> direction = this->random_vector(1).normalized();
  double before = 0;
  for (const double away : {1.0, 10.0, 100.0, 1000.0}) {
    const double distance = filter.gate_distance(filter.position() + away * direction, R);
    EXPECT_GT(distance, before);
    before = distance;
  }
  EXPECT_GT(before, 1);
}

TYPED_TEST_P(FilterInvariants, NothingBecomesNaN) {
  constexpr int D = TypeParam::dimension;
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double dt : {0.0, 1e-9, 0.04, 3600.0}) {
      TypeParam filter(typename TypeParam::Options{}, Vector<D>::Constant(scale), Matrix<D>::Identity());
      for (int i = 0; i < 4; ++i) {
        filter.predict(dt);
        filter.correct(this->random_vector(scale), Matrix<D>::Identity());
      }
      EXPECT_TRUE(filter.position().allFinite());
      EXPECT_TRUE(filter.velocity().allFinite());
      EXPECT_TRUE(filter.covariance().allFinite());
      EXPECT_TRUE(std::isfinite(filter.gate_distance(this->random_vector(scale), Matrix<D>::Identity())));
    }
  }
}

REGISTER_TYPED_TEST_SUITE_P(FilterInvariants, BeginsAtItsFirstMeasurementAtRest, PredictingNoTimeChangesNothing,
                            AMeasurementAtThePredictionDoesNotMoveIt, CovariancesStaySymmetricAndPositive,
                            WaitingDoesNotMakeItSurer, ASteadyWalkIsFollowedWithoutBias, TheSearchAreaIsCentredOnThePrediction,
                            NothingBecomesNaN);

}  // namespace marey::filter
