#include "marey/filter/kalman.h"

#include <gtest/gtest.h>

#include "marey/filter/filter.h"
#include "marey/filter/random_measurements.h"

namespace marey::filter {
namespace {

static_assert(Filter<Kalman<2>> && Filter<Kalman<3>>);

using Kalmans = testing::Types<Kalman<2>, Kalman<3>>;

/// The slow twin: the paper's eq. 4-8 with the matrices A, H and Q written out.
template <int D>
struct TextbookKalman {
  using State = Eigen::Matrix<double, 2 * D, 1>;
  using Square = Eigen::Matrix<double, 2 * D, 2 * D>;
  State x = State::Zero();
  Square P = Square::Zero();
  double density;

  TextbookKalman(const KalmanOptions& options, const Vector<D>& z, const Matrix<D>& R)
      : density(options.acceleration_noise * options.acceleration_noise) {
    x.template head<D>() = z;
    P.template topLeftCorner<D, D>() = R;
    P.template bottomRightCorner<D, D>().diagonal().setConstant(options.initial_speed * options.initial_speed);
  }

  void predict(double dt) {
    Square A = Square::Identity();
    A.template topRightCorner<D, D>().diagonal().setConstant(dt);
    Square Q = Square::Zero();
    Q.template topLeftCorner<D, D>().diagonal().setConstant(density * dt * dt * dt / 3);
    Q.template topRightCorner<D, D>().diagonal().setConstant(density * dt * dt / 2);
    Q.template bottomLeftCorner<D, D>().diagonal().setConstant(density * dt * dt / 2);
    Q.template bottomRightCorner<D, D>().diagonal().setConstant(density * dt);
    x = A * x;
    P = A * P * A.transpose() + Q;
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) {
    Eigen::Matrix<double, D, 2 * D> H = Eigen::Matrix<double, D, 2 * D>::Zero();
    H.template leftCols<D>().setIdentity();
    const Eigen::Matrix<double, 2 * D, D> K = P * H.transpose() * (H * P * H.transpose() + R).inverse();
    x += K * (z - H * x);
    P = (Square::Identity() - K * H) * P;
  }
};

template <typename F>
class KalmanTwin : public testing::Test, public RandomMeasurements<F::dimension> {};
TYPED_TEST_SUITE(KalmanTwin, Kalmans);

TYPED_TEST(KalmanTwin, AgreesWithTheTextbook) {
  constexpr int D = TypeParam::dimension;
  const KalmanOptions options{.acceleration_noise = 50, .initial_speed = 120};
  const Vector<D> start = this->random_vector(100);
  const Matrix<D> R0 = this->random_covariance(2);
  TypeParam fast(options, start, R0);
  TextbookKalman<D> slow(options, start, R0);
  for (int i = 0; i < 200; ++i) {
    const double dt = 0.01 * (1 + i % 9);
    fast.predict(dt);
    slow.predict(dt);
    if (i % 5 != 0) {
      const Vector<D> z = start + this->random_vector(10);
      const Matrix<D> R = this->random_covariance(2);
      fast.correct(z, R);
      slow.correct(z, R);
    }
    EXPECT_LE((fast.position() - slow.x.template head<D>()).norm(), 1e-9);
    EXPECT_LE((fast.velocity() - slow.x.template tail<D>()).norm(), 1e-8);
    const Matrix<D> position_part = slow.P.template topLeftCorner<D, D>();
    const Matrix<D> velocity_part = slow.P.template bottomRightCorner<D, D>();
    EXPECT_LE((fast.covariance() - position_part).norm(), 1e-9 * position_part.norm());
    EXPECT_LE((fast.velocity_covariance() - velocity_part).norm(), 1e-9 * velocity_part.norm());
  }
}

TEST(Kalman, TwoHalfStepsAreOneWhole) {
  Kalman<2> whole({}, {1, 2}, Matrix<2>::Identity());
  Kalman<2> halves = whole;
  whole.predict(0.1);
  halves.predict(0.05);
  halves.predict(0.05);
  EXPECT_LE((whole.covariance() - halves.covariance()).norm(), 1e-9 * whole.covariance().norm());
}

TEST(Kalman, InnovationsAreAsWideAsItSays) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const KalmanOptions options{.acceleration_noise = 30, .initial_speed = 50};
  constexpr double dt = 0.04;
  double normalised = 0;
  constexpr int steps = 20000;
  Vector<2> x(0, 0);
  Vector<2> v(20, -10);
  Kalman<2> filter(options, x, Matrix<2>::Identity());
  for (int i = 0; i < steps; ++i) {
    const Vector<2> kick(normal(random), normal(random));  // exact sampling of the white-acceleration model
    const Vector<2> slip(normal(random), normal(random));
    const double sigma = options.acceleration_noise * std::sqrt(dt);
    x += dt * v + sigma * dt * (kick / 2 + slip / std::sqrt(12.0));
    v += sigma * kick;
    const Vector<2> z = x + Vector<2>(normal(random), normal(random));
    filter.predict(dt);
    const Vector<2> residual = z - filter.position();
    normalised += residual.dot(filter.innovation_covariance(Matrix<2>::Identity()).inverse() * residual);
    filter.correct(z, Matrix<2>::Identity());
  }
  EXPECT_NEAR(normalised / steps, 2, 0.06);
}

}  // namespace
}  // namespace marey::filter
